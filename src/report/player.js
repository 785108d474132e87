// The player of a report: draws quantised frames on a canvas. No library, no network.
(function () {
  "use strict";
  const byId = (id) => document.getElementById(id);
  const run = JSON.parse(byId("player-parameters").textContent);
  const frames = unpack(byId("player-data").textContent.trim());
  const canvas = byId("grains");
  const pen = canvas.getContext("2d");
  const scrub = byId("scrub");
  const play = byId("play");
  const span = run.window.map(([lower, upper]) => upper - lower);
  const PAPER = "#f7f5f0", WALL = "#3c3a36", PERIODIC = "#b9b3a5";
  const FULL_LENGTH = 12; // seconds that a whole run takes at speed 1
  const view = { azimuth: -0.6, elevation: 0.35 };
  const HAZES = 12; // steps from near to far, where colours turn to paper
  const hazy = Array.from({ length: HAZES }, (_, k) => run.colours.map((colour) => blend(colour, PAPER, 0.7 * k / (HAZES - 1))));
  let current = frames.length - 1, isPlaying = false, place = current, lastTick = 0;

  // Significant digits, groups of three, and powers of ten, as everywhere on the page.
  function number(value, digits) {
    if (value === 0) return "0";
    const power = Number(value.toExponential(digits - 1).split("e")[1]);
    if (power < -4 || (power >= 6 && digits < 15)) {
      const raised = String(power).replace(/./g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻");
      return Number((value / 10 ** power).toPrecision(digits)) + " × 10" + raised;
    }
    const [whole, fraction] = Number(value.toPrecision(digits)).toFixed(Math.max(0, Math.min(20, digits - 1 - power))).split(".");
    const grouped = whole.length < 5 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, "\u202f");
    const rest = (fraction || "").replace(/0+$/, "");
    return grouped.replace("-", "−") + (rest ? "." + rest : "");
  }

  function blend(first, second, share) {
    const channel = (colour, k) => parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16);
    const mixed = [0, 1, 2].map((k) => Math.round((1 - share) * channel(first, k) + share * channel(second, k)));
    return `rgb(${mixed.join(",")})`;
  }

  function unpack(text) {
    const raw = atob(text);
    const bytes = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
    const axes = run.deep ? 3 : 2;
    const total = run.counts.reduce((sum, count) => sum + count, 0);
    const data = new DataView(bytes.buffer);
    let grain = 0;
    return run.counts.map((count) => {
      const places = new Float32Array(count * axes);
      for (let k = 0; k < places.length; k++) places[k] = data.getUint16(2 * (grain * axes + k), true) / 65535;
      const start = 2 * axes * total + grain;
      grain += count;
      const kinds = run.diameters ? bytes.subarray(start + total, start + total + count) : null;
      return { count, places, kinds, speeds: bytes.subarray(start, start + count) };
    });
  }

  // The scale of the drawing: where a place of the box, each axis in 0 ... 1, lies on the canvas.
  function projection(width, height) {
    const margin = 7;
    if (!run.deep) {
      const across = run.turned ? span[1] : span[0], up = run.turned ? span[0] : span[1];
      const scale = Math.min((width - 2 * margin) / across, (height - 2 * margin) / up);
      const left = (width - scale * across) / 2, top = (height - scale * up) / 2;
      const at = run.turned
        ? (x, y) => [left + y * span[1] * scale, top + x * span[0] * scale, 0]
        : (x, y) => [left + x * span[0] * scale, top + (1 - y) * span[1] * scale, 0];
      return { scale, at };
    }
    const diagonal = Math.hypot(span[0], span[1], span[2]);
    const scale = Math.min(width / diagonal, height / diagonal) * 0.97;
    const [ca, sa] = [Math.cos(view.azimuth), Math.sin(view.azimuth)];
    const [ce, se] = [Math.cos(view.elevation), Math.sin(view.elevation)];
    const at = (x, y, z) => {
      const u = (x - 0.5) * span[0], v = (y - 0.5) * span[1], w = (z - 0.5) * span[2];
      const across = ca * u - sa * v, away = sa * u + ca * v;
      return [width / 2 + across * scale, height / 2 - (ce * w + se * away) * scale, (ce * away - se * w) / diagonal];
    };
    return { scale, at };
  }

  // The radius of a grain: of its species where grains differ.
  const radiusOf = (frame, k, radii) => (frame.kinds && radii[frame.kinds[k]]) || radii[0];

  function drawGrains(frame, project, radii) {
    // Grains of one colour are drawn in one path; far spheres first and paler.
    if (run.deep) return drawSpheres(frame, project, radii);
    const last = run.colours.length - 1;
    const bins = run.colours.map(() => []);
    for (let k = 0; k < frame.count; k++) bins[Math.min(last, (frame.speeds[k] * (last + 1)) >> 8)].push(k);
    bins.forEach((bin, colour) => {
      if (bin.length === 0) return;
      pen.fillStyle = run.colours[colour];
      pen.beginPath();
      for (const k of bin) {
        const [x, y] = project.at(frame.places[2 * k], frame.places[2 * k + 1]);
        const radius = radiusOf(frame, k, radii);
        pen.moveTo(x + radius, y);
        pen.arc(x, y, radius, 0, 7);
      }
      pen.fill();
    });
  }

  function drawSpheres(frame, project, radii) {
    const spheres = [];
    for (let k = 0; k < frame.count; k++) {
      const place = project.at(frame.places[3 * k], frame.places[3 * k + 1], frame.places[3 * k + 2]);
      place.push(frame.speeds[k], radiusOf(frame, k, radii));
      spheres.push(place);
    }
    spheres.sort((a, b) => b[2] - a[2]);
    const last = run.colours.length - 1;
    pen.lineWidth = 0.7;
    pen.strokeStyle = "rgba(30, 20, 40, 0.35)";
    for (const [x, y, depth, speed, radius] of spheres) {
      const haze = Math.max(0, Math.min(1, 0.5 + depth)) * (HAZES - 1);
      pen.fillStyle = hazy[Math.round(haze)][Math.min(last, (speed * (last + 1)) >> 8)];
      pen.beginPath();
      pen.arc(x, y, radius, 0, 7);
      pen.fill();
      if (radius > 2.5) pen.stroke();
    }
  }

  // The sides of the box: walls thick, periodic sides dashed, open sides not at all.
  function drawSides(project) {
    const edges = run.deep
      ? [0, 1].flatMap((b) => [0, 1].flatMap((c) => [
          [[0, b, c], [1, b, c], [[1, b], [2, c]]], [[b, 0, c], [b, 1, c], [[0, b], [2, c]]], [[b, c, 0], [b, c, 1], [[0, b], [1, c]]]]))
      : [0, 1].flatMap((b) => [[[0, b, 0], [1, b, 0], [[1, b]]], [[b, 0, 0], [b, 1, 0], [[0, b]]]]);
    for (const [from, to, faces] of edges) {
      const kinds = faces.map(([axis, side]) => run.sides[axis][side]);
      const isWall = kinds.some((kind) => kind === "wall"), isPeriodic = kinds.some((kind) => kind === "periodic");
      if (!isWall && !isPeriodic && !run.deep) continue;
      const outward = isWall && !run.deep ? 1.5 : 0;
      const [x0, y0] = project.at(...from), [x1, y1] = project.at(...to);
      const middle = [canvas.clientWidth / 2, canvas.clientHeight / 2];
      const shift = Math.abs(x1 - x0) > Math.abs(y1 - y0)
        ? [0, Math.sign(y0 - middle[1]) * outward] : [Math.sign(x0 - middle[0]) * outward, 0];
      pen.strokeStyle = isWall ? WALL : PERIODIC;
      pen.lineWidth = isWall ? (run.deep ? 1.5 : 3) : 1;
      pen.setLineDash(isWall ? [] : [5, 4]);
      pen.beginPath();
      pen.moveTo(x0 + shift[0], y0 + shift[1]);
      pen.lineTo(x1 + shift[0], y1 + shift[1]);
      pen.stroke();
    }
    pen.setLineDash([]);
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = PAPER;
    pen.fillRect(0, 0, width, height);
    const project = projection(width, height);
    const radii = (run.diameters || [run.diameter]).map((diameter) => Math.max(0.9, 0.5 * diameter * project.scale));
    if (run.deep) drawSides(project);
    drawGrains(frames[current], project, radii);
    if (!run.deep) drawSides(project);
    const time = number(run.times[current], 4) + (run.units.time ? "\u202f" + run.units.time : "");
    const grains = run.grains[current];
    byId("clock").textContent = "t = " + time + " · " + number(grains, 15) + (grains === 1 ? " grain" : " grains");
    byId("fastest").textContent = number(run.speeds[current], 3);
    byId("speed-unit").textContent = "speed" + run.units.speed;
    scrub.setAttribute("aria-valuetext", "time " + time);
  }

  function show(frame) {
    current = Math.max(0, Math.min(frames.length - 1, Math.round(frame)));
    scrub.value = String(current);
    draw();
  }

  function setPlaying(wanted) {
    isPlaying = wanted && frames.length > 1;
    play.textContent = isPlaying ? "❚❚" : "▶";
    play.setAttribute("aria-label", isPlaying ? "Pause" : "Play");
    if (!isPlaying) return;
    place = current >= frames.length - 1 ? 0 : current;
    lastTick = performance.now();
    requestAnimationFrame(tick);
  }

  function tick(now) {
    if (!isPlaying) return;
    const rate = Number(byId("speed").value) * Math.max(4, frames.length / FULL_LENGTH);
    place += Math.max(0, now - lastTick) / 1000 * rate;
    lastTick = now;
    if (Math.floor(place) !== current) show(Math.floor(place));
    if (place >= frames.length - 1) setPlaying(false);
    else requestAnimationFrame(tick);
  }

  function onKey(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: 10, PageDown: -10 }[event.key];
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === " ") setPlaying(!isPlaying);
    else if (event.shiftKey && turn && run.deep) orbit(turn[0], turn[1]);
    else if (event.key === "Home") halt(0);
    else if (event.key === "End") halt(frames.length - 1);
    else if (step) halt(current + step);
    else return;
    event.preventDefault();
  }

  function halt(frame) {
    setPlaying(false);
    show(frame);
  }

  function orbit(around, up) {
    view.azimuth += around;
    view.elevation = Math.max(-1.5, Math.min(1.5, view.elevation + up));
    draw();
  }

  play.addEventListener("click", () => setPlaying(!isPlaying));
  scrub.addEventListener("input", () => halt(Number(scrub.value)));
  canvas.addEventListener("keydown", onKey);
  canvas.addEventListener("pointerdown", (event) => { if (run.deep) canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", (event) => {
    if (run.deep && event.buttons === 1) orbit(0.008 * event.movementX, 0.008 * event.movementY);
  });
  if (run.deep) canvas.classList.add("orbit");
  new ResizeObserver(draw).observe(canvas);
  draw();
})();
