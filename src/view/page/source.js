// Where frames and series come from: the server that gave the page, or the page itself.
// A frame: points, axes, time, grains, detail, row [column], places [point * axes], speeds, scalars, diameters [point].

function servedSource() {
  const token = new URLSearchParams(location.search).get("token") || "";
  async function get(path, query) {
    const answer = await fetch(path + "?" + new URLSearchParams({ token, ...query }), { cache: "no-store" });
    if (!answer.ok) throw new Error((await answer.text()).trim());
    return answer;
  }
  return {
    about: () => get("about", {}).then((answer) => answer.json()),
    frame: async (log, number, colour) => {
      const answer = await get("frame", { log, number, colour });
      return servedFrame(await answer.arrayBuffer());
    },
    rows: async (log, from, step, count) => {
      const answer = await get("series", { log, from, step, count });
      return new Float64Array(await answer.arrayBuffer());
    },
  };
}

function servedFrame(buffer) {
  const [points, columns, follows, axes] = new Uint32Array(buffer, 0, 4);
  const [time, grains, detail] = new Float64Array(buffer, 16, 3);
  let at = 40 + 8 * columns;
  const floats = (count) => { at += 4 * count; return new Float32Array(buffer, at - 4 * count, count); };
  return {
    points, axes, time, grains, detail, bytes: buffer.byteLength,
    row: new Float64Array(buffer, 40, columns),
    places: floats(points * axes), speeds: floats(points),
    scalars: follows & 1 ? floats(points) : null,
    diameters: follows & 2 ? floats(points) : null,
  };
}

// Frames in the page are coarse: two bytes for a place, one for a speed, a density, a cluster.
function embeddedSource(about) {
  const packs = about.logs.map((log, index) => {
    const raw = atob(byId("data-" + index).textContent.trim());
    const bytes = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
    const frames = [];
    let at = 0;
    for (let k = 0; k < log.times.length; k++) {
      frames.push(embeddedFrame(bytes.buffer, at, log));
      at = frames[k].end;
    }
    return { frames, rows: new Float64Array(bytes.buffer, at, log.embedded_rows * log.columns.length) };
  });
  return {
    about: async () => about,
    frame: async (log, number, colour) => {
      const frame = packs[log].frames[number];
      const [scalars, detail] = colour === "density" ? [frame.densities, frame.details[0]]
        : colour === "clusters" ? [frame.clusters, frame.details[1]] : [null, 0];
      return { ...frame, scalars, detail };
    },
    rows: async (log, from, step, count) => {
      const columns = about.logs[log].columns.length, every = about.logs[log].row_step;
      const first = Math.ceil(from / every);
      return packs[log].rows.slice(first * columns, (first + count) * columns);
    },
  };
}

function embeddedFrame(buffer, start, log) {
  const [points, columns, follows, axes] = new Uint32Array(buffer, start, 4);
  const [time, grains, fastest, ...details] = new Float64Array(buffer, start + 16, 5);
  const row = new Float64Array(buffer, start + 56, columns);
  let at = start + 56 + 8 * columns;
  const coarse = new Uint16Array(buffer, at, points * axes);
  at += 2 * points * axes;
  at += (4 - at % 4) % 4;
  const diameters = follows & 4 ? new Float32Array(buffer, at, points) : null;
  if (diameters) at += 4 * points;
  const bytes = () => { at += points; return new Uint8Array(buffer, at - points, points); };
  const places = new Float32Array(points * axes);
  for (let k = 0; k < places.length; k++) {
    const [lower, upper] = log.window[k % axes];
    places[k] = lower + (upper - lower) * coarse[k] / 65535;
  }
  const speeds = Float32Array.from(bytes(), (byte) => byte / 255 * fastest);
  const densities = follows & 1 ? Float32Array.from(bytes(), (byte) => byte / 255) : null;
  const clusters = follows & 2 ? Float32Array.from(bytes(), (byte) => Math.round(Math.exp(byte / 255 * Math.log(Math.max(2, grains))))) : null;
  const end = at + (8 - at % 8) % 8;
  return { points, axes, time, grains, details, row, places, speeds, densities, clusters, diameters, end, bytes: 0 };
}
