// Frames that were asked for: kept while there is room, those wanted most asked for first.
const MOST_BYTES = 160e6, AT_ONCE = 4;

function frameStore(source, arrived, failed) {
  const kept = new Map(); // in the order of use
  const faults = new Map(); // what is wrong with frames that cannot be had
  const running = new Set();
  let wishes = [], bytes = 0;
  const keyOf = (log, number, colour) => `${log}:${number}:${colour}`;

  function ask() {
    while (running.size < AT_ONCE && wishes.length > 0) {
      const [log, number, colour] = wishes.shift();
      const key = keyOf(log, number, colour);
      if (kept.has(key) || faults.has(key) || running.has(key)) continue;
      running.add(key);
      source.frame(log, number, colour)
        .then((frame) => keep(key, frame), (error) => {
          // A server that does not answer may answer again; a damaged frame stays damaged.
          if (error instanceof TypeError) return failed(log, "The server does not answer: was it ended?");
          faults.set(key, error.message);
          arrived();
        })
        .finally(() => {
          running.delete(key);
          ask();
        });
    }
  }

  function keep(key, frame) {
    kept.set(key, frame);
    bytes += frame.bytes;
    for (const [old, other] of kept) {
      if (bytes <= MOST_BYTES || old === key) break;
      kept.delete(old);
      bytes -= other.bytes;
    }
    arrived();
  }

  return {
    // The frame, if it is there.
    get(log, number, colour) {
      const key = keyOf(log, number, colour), frame = kept.get(key);
      if (frame) {
        kept.delete(key);
        kept.set(key, frame);
      }
      return frame;
    },
    // What is wrong with the frame, if anything.
    fault: (log, number, colour) => faults.get(keyOf(log, number, colour)),
    // What is wanted now, the most urgent first; what was wanted before and is not any more is not asked for.
    want(list) {
      wishes = list;
      ask();
    },
  };
}
