// A log on the page: its canvases, its legend, what is shown of it.

function makePane(parent, log, index, count, player) {
  const pane = element("div", parent, { className: "pane" });
  if (count > 1) {
    const head = element("h3", pane, {});
    const sign = element("i", head, {});
    sign.style.borderTopColor = `var(--series-${index})`;
    sign.style.borderTopStyle = index ? "dashed" : "solid";
    element("span", head, { textContent: `${log.title} · ${log.engine}` });
    element("small", head, { textContent: log.name });
  }
  const stage = element("div", pane, { className: "stage", tabIndex: 0 });
  stage.setAttribute("role", "img");
  const [under, grains, over] = ["under", "grains", "over"].map((name) => element("canvas", stage, { className: name }));
  const message = element("p", stage, { textContent: "reading …" });
  message.setAttribute("role", "status");
  const state = element("div", pane, { className: "state" });
  const moment = element("span", state, {});
  const legend = element("div", state, { className: "colours" });
  const [least, bar, most, unit] = ["span", "i", "span", "em"].map((name) => element(name, legend, {}));
  const painter = glPainter(grains) || flatPainter(grains);
  stage.style.aspectRatio = String(aspect(log));
  let frame = null;

  // Values that colour the grains, and the range of the scale.
  function colours() {
    const colour = player.colour();
    const values = colour === "speed" ? frame.speeds : frame.scalars || new Float32Array(frame.points).fill(NaN);
    if (colour === "clusters") {
      return { values, range: [0, Math.log(Math.max(2, player.ownScale() ? frame.detail : frame.grains))], logarithmic: true, map: player.map("field"), label: "grains in the cluster" };
    }
    const fixed = colour === "speed" ? log.fastest : 1;
    const end = player.ownScale() ? quantile(values) || fixed : fixed;
    const label = colour === "speed" ? log.units.speed : `volume fraction, over cells of side ${number(frame.detail, 2)}${log.units.length ? "\u202f" + log.units.length : ""}`;
    return { values, range: [0, end], logarithmic: false, map: player.map(colour === "speed" ? "speed" : "field"), label };
  }

  const draw = oncePerPicture(() => {
    const ratio = fitCanvas(grains);
    fitCanvas(under);
    fitCanvas(over);
    const eye = projection(log, grains.width / ratio, grains.height / ratio);
    drawSides(log, eye, under, over, ratio);
    if (!frame) return painter({ frame, ratio });
    const own = colours();
    painter({ frame, log, eye, ratio, ...own });
    least.textContent = own.logarithmic ? "1" : "0";
    most.textContent = number(own.logarithmic ? Math.exp(own.range[1]) : own.range[1], 3);
    unit.textContent = own.label;
    bar.style.background = `linear-gradient(to right, ${own.map.filter((_, k) => k % 9 === 0).join(", ")})`;
  });

  function show(next, note) {
    frame = next;
    message.hidden = !note;
    message.textContent = note || "";
    const time = `t = ${number(frame.time, 5)}${log.units.time ? "\u202f" + log.units.time : ""}`;
    const shown = frame.points < frame.grains ? `${number(frame.points, 15)} of ${number(frame.grains, 15)} grains` : frame.grains === 1 ? "1 grain" : `${number(frame.grains, 15)} grains`;
    moment.textContent = `${time} · ${shown}`;
    stage.setAttribute("aria-label", `${log.title}: the grains at ${time}, ${shown}, coloured by ${player.colour()}`);
    draw();
  }

  listen(stage, player, log);
  new ResizeObserver(draw).observe(stage);
  return {
    draw, show, stage, frame: () => frame, isFast: painter.isFast,
    // Nothing to show, and why.
    blank(text) {
      frame = null;
      message.hidden = false;
      message.textContent = text;
      moment.textContent = "";
      draw();
    },
    say: (text) => { message.hidden = !text; message.textContent = text; },
  };
}

// Width over height of the stage.
function aspect(log) {
  const span = log.window.map(([lower, upper]) => upper - lower);
  if (log.deep) return 1.45;
  const across = log.turned ? span[1] / span[0] : span[0] / span[1];
  return Math.max(0.9, Math.min(8, across));
}

// The value that 98 of 100 do not exceed, from at most some thousands of them.
function quantile(values) {
  const step = Math.max(1, Math.floor(values.length / 4000));
  const some = [];
  for (let k = 0; k < values.length; k += step) if (Number.isFinite(values[k])) some.push(values[k]);
  some.sort((a, b) => a - b);
  return some.length ? some[Math.floor((some.length - 1) * 0.98)] : 0;
}

// Dragging turns a deep box and moves a flat one; the wheel zooms both.
function listen(stage, player, log) {
  stage.addEventListener("pointerdown", (event) => { stage.setPointerCapture(event.pointerId); });
  stage.addEventListener("pointermove", (event) => {
    if (event.buttons === 0) return;
    if (log.deep && event.buttons === 1 && !event.shiftKey) player.turn(0.008 * event.movementX, 0.008 * event.movementY);
    else player.move(event.movementX / stage.clientWidth, event.movementY / stage.clientHeight);
  });
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    const box = stage.getBoundingClientRect();
    player.zoom(Math.exp(-0.0015 * event.deltaY), (event.clientX - box.left) / box.width - 0.5, (event.clientY - box.top) / box.height - 0.5);
  }, { passive: false });
}
