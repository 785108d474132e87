// How a place in the box comes to a place on the canvas; both panes have the same view.
const FIRST_VIEW = { azimuth: -0.6, elevation: 0.35, zoom: 1, across: 0, up: 0 };
const view = { ...FIRST_VIEW };

// For a canvas of the given size: scale [pixel per length], unit vectors to the right, up and away, the centre.
function projection(log, width, height) {
  const span = log.window.map(([lower, upper]) => upper - lower);
  const centre = log.window.map(([lower, upper]) => (lower + upper) / 2);
  if (!log.deep) {
    const across = log.turned ? span[1] : span[0], up = log.turned ? span[0] : span[1];
    const scale = view.zoom * Math.min((width - 14) / across, (height - 14) / up);
    const axes = log.turned ? { right: [0, 1, 0], up: [-1, 0, 0] } : { right: [1, 0, 0], up: [0, 1, 0] };
    return { scale, centre: [centre[0], centre[1], 0], away: [0, 0, 1], depth: 1, shift: [view.across * width, view.up * height], ...axes };
  }
  const depth = Math.hypot(...span);
  const [ca, sa] = [Math.cos(view.azimuth), Math.sin(view.azimuth)];
  const [ce, se] = [Math.cos(view.elevation), Math.sin(view.elevation)];
  return {
    scale: view.zoom * Math.min(width, height) / depth * 0.97, centre, depth, shift: [view.across * width, view.up * height],
    right: [ca, -sa, 0], up: [se * sa, se * ca, ce], away: [ce * sa, ce * ca, -se],
  };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// Place on a canvas of the given size, and how far away: −½ … ½.
function projected(eye, place, width, height) {
  const from = [0, 1, 2].map((axis) => (place[axis] || 0) - eye.centre[axis]);
  return [
    width / 2 + eye.shift[0] + eye.scale * dot(eye.right, from),
    height / 2 + eye.shift[1] - eye.scale * dot(eye.up, from),
    dot(eye.away, from) / eye.depth,
  ];
}

// The edges of the box; with the sides that meet there.
function edges(log) {
  const corner = (sides) => sides.map((side, axis) => log.window[axis][side]);
  const both = [0, 1];
  if (!log.deep) {
    return both.flatMap((b) => [
      [corner([0, b, 0]), corner([1, b, 0]), [[1, b]]], [corner([b, 0, 0]), corner([b, 1, 0]), [[0, b]]]]);
  }
  return both.flatMap((b) => both.flatMap((c) => [
    [corner([0, b, c]), corner([1, b, c]), [[1, b], [2, c]]],
    [corner([b, 0, c]), corner([b, 1, c]), [[0, b], [2, c]]],
    [corner([b, c, 0]), corner([b, c, 1]), [[0, b], [1, c]]]]));
}

// Walls thick, periodic sides dashed, open sides of a flat box not at all. Of a deep box, those edges that are behind
// the grains go under them.
function drawSides(log, eye, under, over, ratio) {
  const pens = [under, over].map((canvas) => canvas.getContext("2d"));
  const width = over.width / ratio, height = over.height / ratio;
  for (const pen of pens) {
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
  }
  const farthest = [0, 1, 2].map((axis) => log.window[axis][eye.away[axis] > 0 ? 1 : 0]);
  for (const [from, to, faces] of edges(log)) {
    const kinds = faces.map(([axis, side]) => log.sides[axis][side]);
    const isWall = kinds.includes("wall"), isPeriodic = kinds.includes("periodic");
    if (!isWall && !isPeriodic && !log.deep) continue;
    const isBehind = log.deep && [from, to].some((end) => end.every((place, axis) => place === farthest[axis]));
    const pen = pens[isBehind ? 0 : 1];
    const [x0, y0] = projected(eye, from, width, height), [x1, y1] = projected(eye, to, width, height);
    // A wall of a flat box lies outside of what the grains have.
    const outward = isWall && !log.deep ? 1.5 : 0;
    const middle = projected(eye, eye.centre, width, height);
    const shift = Math.abs(x1 - x0) > Math.abs(y1 - y0)
      ? [0, Math.sign(y0 - middle[1]) * outward] : [Math.sign(x0 - middle[0]) * outward, 0];
    pen.strokeStyle = isWall ? WALL : PERIODIC;
    pen.lineWidth = isWall && !log.deep ? 3 : isWall ? 1.8 : 1.2;
    pen.setLineDash(isWall ? [] : [5, 5]);
    pen.beginPath();
    pen.moveTo(x0 + shift[0], y0 + shift[1]);
    pen.lineTo(x1 + shift[0], y1 + shift[1]);
    pen.stroke();
  }
  pens.forEach((pen) => pen.setLineDash([]));
  if (log.deep) drawAxes(eye, pens[1], height);
  if (log.gravity.some((component) => component !== 0)) drawGravity(log, eye, pens[1], width);
}

// Which way grains fall.
function drawGravity(log, eye, pen, width) {
  const gravity = [0, 1, 2].map((axis) => log.gravity[axis] || 0), strength = Math.hypot(...gravity);
  const way = [dot(eye.right, gravity) / strength, -dot(eye.up, gravity) / strength];
  const [x, y] = [width - 30, 32], tip = [x + 15 * way[0], y + 15 * way[1]];
  pen.font = "italic 14px Georgia, serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.lineCap = "round";
  // Upon paper, so that it can be told from the grains.
  for (const [colour, thickness] of [[PAPER, 6], ["#4a463f", 1.8]]) {
    pen.strokeStyle = pen.fillStyle = colour;
    pen.lineWidth = thickness;
    pen.beginPath();
    pen.moveTo(x - 15 * way[0], y - 15 * way[1]);
    pen.lineTo(...tip);
    for (const turn of [2.6, -2.6]) {
      pen.moveTo(...tip);
      pen.lineTo(tip[0] + 7 * (way[0] * Math.cos(turn) - way[1] * Math.sin(turn)), tip[1] + 7 * (way[0] * Math.sin(turn) + way[1] * Math.cos(turn)));
    }
    pen.stroke();
    pen.lineWidth = 4;
    if (colour === PAPER) pen.strokeText("g", x + 12 * Math.abs(way[1]), y + 12 * Math.abs(way[0]));
    else pen.fillText("g", x + 12 * Math.abs(way[1]), y + 12 * Math.abs(way[0]));
  }
  pen.lineCap = "butt";
}

// Which way x, y and z go.
function drawAxes(eye, pen, height) {
  const origin = [38, height - 34], length = 24;
  pen.lineWidth = 1.4;
  pen.strokeStyle = pen.fillStyle = "#6c675f";
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  ["x", "y", "z"].forEach((name, axis) => {
    const [across, up] = [eye.right[axis], -eye.up[axis]];
    pen.beginPath();
    pen.moveTo(...origin);
    pen.lineTo(origin[0] + length * across, origin[1] + length * up);
    pen.stroke();
    const far = Math.hypot(across, up) < 0.2 ? 8 : 0;
    pen.fillText(name, origin[0] + (length + 9) * across + far, origin[1] + (length + 9) * up - far);
  });
}
