// The page: one clock for all logs, what is shown at it, and what the user does.
const FULL_LENGTH = 12, SLOWEST = 4, FASTEST = 25; // seconds of a whole log at speed 1; frames per second
const AHEAD = 6; // frames asked for before they are due

function makePlayer(source, about) {
  const logs = about.logs;
  const own = { place: 0, isPlaying: false, at: 0, lastTick: 0, stations: [], panes: [], plots: new Map() };
  const drawPlots = oncePerPicture(() => {
    const unit = abscissaColumn() === "time" && logs[0].units.time ? ` [${logs[0].units.time}]` : "";
    byId("measures").textContent = `Measures against ${api.abscissaName()}${unit}`;
    own.plots.forEach((plot) => plot.draw());
    const steps = logs.map((log, k) => Math.max(log.row_step || 1, collected.series[k].step));
    const isReading = collected.series.some((series) => !series.isWhole);
    const thinned = Math.max(...steps) > 1 ? `Curves show every ${steps.join(" or ")}th recording; the values at the cursor are those of the frame. ` : "";
    const lost = collected.series.reduce((sum, series) => sum + series.rows.filter((row) => Number.isNaN(row[0])).length, 0);
    const gaps = lost ? `${lost === 1 ? "One recording is" : lost + " recordings are"} damaged in the log and left out. ` : "";
    byId("series-remark").textContent = thinned + gaps + (isReading ? "The series is being read …" : "");
  });

  const collected = seriesOf(source, logs, drawPlots);
  const store = frameStore(source, refresh, (log, text) => {
    setPlaying(false);
    own.panes[log].say(text);
  });
  const api = {
    logs,
    colour: () => byId("colour").value,
    ownScale: () => byId("own").checked,
    map: (name) => about.colours[name],
    turn: (around, up) => look(() => { view.azimuth += around; view.elevation = Math.max(-1.5, Math.min(1.5, view.elevation + up)); }),
    move: (across, up) => look(() => { view.across += across; view.up += up; }),
    zoom: (factor, across, up) => look(() => zoom(factor, across, up)),
    isLogarithmic: () => byId("logarithmic").checked,
    rows: (log) => collected.series[log].rows,
    row: (log) => own.panes[log].frame() && own.panes[log].frame().row,
    abscissa: (log) => logs[log].columns.findIndex((column) => column.name === abscissaColumn()),
    abscissaName: () => (abscissaColumn() === "time" ? "time" : "collisions per particle"),
    range: () => (own.stations.length ? [own.stations[0].place, own.stations[own.stations.length - 1].place] : [0, 1]),
    place: () => (own.stations.length ? own.stations[own.at].place : 0),
    seek: (place) => halt(nearest(place)),
  };

  const abscissaColumn = () => (byId("step").value === "collisions" ? "collisions_per_particle" : "time");

  function look(change) {
    change();
    own.panes.forEach((pane) => pane.draw());
  }

  // What is under the pointer stays there.
  function zoom(factor, across, up) {
    const held = Math.max(0.5, Math.min(200, view.zoom * factor)) / view.zoom;
    view.zoom *= held;
    view.across = across + (view.across - across) * held;
    view.up = up + (view.up - up) * held;
  }

  // The times of all logs, each with the frame of every log that is the last one then.
  function stationsOf(places) {
    const all = [...new Set(places.flat())].sort((a, b) => a - b);
    const next = places.map(() => 0);
    return all.map((place) => {
      places.forEach((own, log) => { while (next[log] + 1 < own.length && own[next[log] + 1] <= place) next[log]++; });
      return { place, frames: [...next] };
    });
  }

  async function arrange() {
    // A log is opened at its end, as a report is; later the first log stays where it is.
    const before = own.stations.length ? own.stations[own.at].frames[0] : Infinity;
    const isTime = byId("step").value === "time";
    own.stations = stationsOf(isTime ? logs.map((log) => log.times) : await Promise.all(logs.map(collisionsAtFrames)));
    const scrub = byId("scrub");
    scrub.max = String(Math.max(0, own.stations.length - 1));
    scrub.disabled = own.stations.length < 2;
    const same = own.stations.findIndex((station) => station.frames[0] >= before);
    show(same < 0 ? own.stations.length - 1 : same);
    drawPlots();
  }

  // Collisions per particle at every frame: known only when every row of the series was read.
  async function collisionsAtFrames(log, index) {
    const column = log.columns.findIndex((one) => one.name === "collisions_per_particle"), width = log.columns.length;
    const every = log.row_step || 1, found = [];
    while (found.length * every < log.rows) {
      remark(`Reading collisions per particle: ${Math.round(100 * found.length * every / log.rows)} %`);
      const numbers = await source.rows(index, found.length * every, every, 512);
      if (numbers.length < width) break;
      // A recording that is damaged counts as the one before it.
      for (let k = column; k < numbers.length; k += width) found.push(Number.isNaN(numbers[k]) ? found[found.length - 1] || 0 : numbers[k]);
    }
    remark("");
    return log.recordings.map((row) => found[Math.min(found.length - 1, Math.floor(row / every))]);
  }

  function nearest(place) {
    let best = 0;
    own.stations.forEach((station, k) => { if (Math.abs(station.place - place) < Math.abs(own.stations[best].place - place)) best = k; });
    return best;
  }

  // What is wanted: what is shown, then what comes next.
  function wish() {
    const stride = Math.max(1, Math.round(rate() / FASTEST)), list = [];
    for (let k = 0; k <= (own.isPlaying ? AHEAD : 1); k++) {
      const station = own.stations[Math.min(own.stations.length - 1, own.at + k * stride)];
      if (station) station.frames.forEach((number, log) => { if (logs[log].times.length) list.push([log, number, api.colour()]); });
    }
    store.want(list);
  }

  function isThere(at) {
    const is = (number, log) => store.get(log, number, api.colour()) || store.fault(log, number, api.colour());
    return own.stations[at].frames.every((number, log) => !logs[log].times.length || is(number, log));
  }

  // Shows what is there of the present station.
  function refresh() {
    const station = own.stations[own.at];
    if (!station) return;
    own.panes.forEach((pane, log) => {
      if (!logs[log].times.length) return pane.say("The log holds no frames.");
      const frame = store.get(log, station.frames[log], api.colour());
      const fault = store.fault(log, station.frames[log], api.colour());
      if (fault) pane.blank(fault);
      if (frame && frame !== pane.frame()) pane.show(frame, noteOf(log, station, frame));
    });
    drawPlots();
  }

  // What there is to say of a frame.
  function noteOf(log, station, frame) {
    if (api.colour() !== "speed" && !frame.scalars) {
      return api.colour() === "clusters" ? "No clusters here: grains are missing, or too many lie upon each other." : "No local density here.";
    }
    const isOver = logs.length > 1 && station.frames[log] === logs[log].times.length - 1 && station.place > (frame.row[api.abscissa(log)] ?? Infinity) * (1 + 1e-9);
    return isOver ? "This log has ended: its last frame." : "";
  }

  function show(at) {
    own.at = Math.max(0, Math.min(own.stations.length - 1, Math.round(at)));
    const scrub = byId("scrub");
    scrub.value = String(own.at);
    const unit = logs[0].units.time ? "\u202f" + logs[0].units.time : "";
    const text = byId("step").value === "time" ? `t = ${number(api.place(), 5)}${unit}` : `${number(api.place(), 5)} collisions per particle`;
    byId("clock").textContent = text;
    scrub.setAttribute("aria-valuetext", text);
    wish();
    refresh();
  }

  // Stations per second.
  const rate = () => Number(byId("speed").value) * Math.max(SLOWEST, Math.min(FASTEST, own.stations.length / FULL_LENGTH));

  function setPlaying(wanted) {
    own.isPlaying = wanted && own.stations.length > 1;
    const play = byId("play");
    play.textContent = own.isPlaying ? "❚❚" : "▶";
    play.setAttribute("aria-label", own.isPlaying ? "Pause" : "Play");
    if (!own.isPlaying) return;
    if (own.at >= own.stations.length - 1) show(0);
    own.place = own.at;
    own.lastTick = performance.now();
    wish();
    requestAnimationFrame(tick);
  }

  // Time goes on only as far as frames are there.
  function tick(now) {
    if (!own.isPlaying) return;
    const wanted = own.place + Math.max(0, now - own.lastTick) / 1000 * rate();
    own.lastTick = now;
    const next = Math.min(own.stations.length - 1, Math.floor(wanted));
    if (next === own.at) own.place = wanted;
    else if (isThere(next)) {
      own.place = wanted;
      show(next);
    } else store.want(own.stations[next].frames.map((number, log) => [log, number, api.colour()]));
    if (own.at >= own.stations.length - 1) setPlaying(false);
    else requestAnimationFrame(tick);
  }

  function halt(at) {
    setPlaying(false);
    show(at);
  }

  function onKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    // Lists and ticks have keys of their own; a button has the space bar.
    const target = event.target.tagName, type = event.target.type;
    if (target === "SELECT" || target === "SUMMARY" || (target === "INPUT" && type === "checkbox" && event.key === " ") || (target === "BUTTON" && event.key === " ")) return;
    const last = own.stations.length - 1;
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const steps = { ArrowLeft: -1, ArrowRight: 1, PageUp: 10, PageDown: -10 }[event.key];
    const jumps = { Home: 0, End: last }[event.key];
    const zooms = { "+": 1.25, "=": 1.25, "-": 0.8 }[event.key];
    if (event.key === " ") setPlaying(!own.isPlaying);
    else if (event.shiftKey && turns) logs.some((log) => log.deep) ? api.turn(0.1 * turns[0], 0.1 * turns[1]) : api.move(0.05 * turns[0], -0.05 * turns[1]);
    else if (jumps !== undefined) halt(jumps);
    else if (steps) halt(own.at + steps);
    else if (zooms) api.zoom(zooms, 0, 0);
    else if (event.key === "0") look(() => Object.assign(view, FIRST_VIEW));
    else return;
    event.preventDefault();
  }

  const remark = (text) => { byId("remark").textContent = text; };

  // A plot for each measure that is ticked.
  function chooseColumns() {
    const labels = new Map();
    logs.forEach((log) => log.columns.forEach((column) => { if (column.name !== "time" && !labels.has(column.name)) labels.set(column.name, column.label); }));
    const preferred = PREFERRED.filter((name) => labels.has(name));
    const first = new Set([...preferred, ...labels.keys()].slice(0, 3));
    for (const [name, text] of labels) {
      const label = element("label", byId("column-list"), {});
      const box = element("input", label, { type: "checkbox", checked: first.has(name), value: name });
      label.append(" " + text);
      const follow = () => {
        if (box.checked && !own.plots.has(name)) own.plots.set(name, makePlot(byId("plots"), name, text, api));
        else if (!box.checked && own.plots.has(name)) {
          own.plots.get(name).remove();
          own.plots.delete(name);
        }
        drawPlots();
      };
      box.addEventListener("change", follow);
      if (box.checked) follow();
    }
  }

  // Colours that a log cannot have are not offered, and it is said why.
  function chooseColours() {
    const reasons = [];
    for (const option of byId("colour").options) {
      const reason = logs.map((log) => log.without[option.value]).find(Boolean);
      if (!reason) continue;
      option.disabled = true;
      reasons.push(`No colour by ${option.textContent}: ${reason}.`);
    }
    return reasons;
  }

  function listenAll() {
    byId("play").addEventListener("click", () => setPlaying(!own.isPlaying));
    byId("scrub").addEventListener("input", (event) => halt(Number(event.target.value)));
    byId("colour").addEventListener("change", () => show(own.at));
    byId("own").addEventListener("change", () => own.panes.forEach((pane) => pane.draw()));
    byId("step").addEventListener("change", arrange);
    byId("logarithmic").addEventListener("change", drawPlots);
    byId("reset").addEventListener("click", () => look(() => Object.assign(view, FIRST_VIEW)));
    document.addEventListener("keydown", onKey);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawPlots);
  }

  async function start() {
    byId("own").checked = logs.some((log) => log.own_scale);
    byId("stages").classList.toggle("two", logs.length > 1);
    own.panes = logs.map((log, index) => makePane(byId("stages"), log, index, logs.length, api));
    const notes = logs.flatMap((log) => log.notes).concat(chooseColours());
    if (!own.panes.every((pane) => pane.isFast)) notes.push("This browser gives no WebGL2: grains are drawn by a plain canvas, which is slow beyond some thousands.");
    logs.flatMap((log) => log.remarks).forEach((text) => element("p", byId("notes"), { className: "hint", textContent: text }));
    for (const note of notes) element("p", byId("notes"), { className: "warning", textContent: note });
    const haveCollisions = logs.every((log) => log.columns.some((column) => column.name === "collisions_per_particle"));
    byId("step-label").hidden = logs.length < 2 || !haveCollisions;
    listenAll();
    await arrange();
    chooseColumns();
    for (let log = 0; log < logs.length; log++) await collected.fill(log).catch((error) => own.panes[log].say(error.message));
  }

  return { start };
}

(async function () {
  const embedded = JSON.parse(byId("about").textContent);
  const source = embedded ? embeddedSource(embedded) : servedSource();
  try {
    await makePlayer(source, await source.about()).start();
  } catch (error) {
    element("p", byId("notes"), { className: "warning", textContent: "The page cannot go on: " + error.message });
    throw error;
  }
})();
