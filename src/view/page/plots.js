// Measures against time, with a cursor at the time that is shown.
const PREFERRED = ["kinetic_energy", "temperature", "collisions_per_particle", "heap_height", "centre_of_mass_height", "pressure", "wall_shear_stress", "flow_velocity", "density_contrast"];
const FEWEST_ROWS = 600; // rows that a plot needs not to look coarse

// The series of all logs, as they come in: rows[log] is a list of rows.
function seriesOf(source, logs, changed) {
  const series = logs.map((log) => ({ step: Math.max(1, Math.ceil(log.rows / FEWEST_ROWS)), rows: [], isWhole: false }));
  async function fill(index) {
    const log = logs[index], own = series[index];
    const width = log.columns.length;
    const wanted = Math.ceil(log.rows / own.step);
    while (own.rows.length < wanted) {
      const numbers = await source.rows(index, own.rows.length * own.step, own.step, wanted - own.rows.length);
      if (numbers.length < width) break;
      for (let k = 0; k + width <= numbers.length; k += width) own.rows.push(numbers.subarray(k, k + width));
      changed();
    }
    own.isWhole = true;
    changed();
  }
  return { series, fill };
}

function ticks(lower, upper, most) {
  const rough = (upper - lower) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((one) => one >= rough) || rough;
  const found = [];
  for (let k = Math.ceil(lower / step - 1e-9); k * step <= upper + 1e-9 * step; k++) found.push(k * step);
  return found;
}

function decades(lower, upper) {
  const found = [];
  const every = Math.max(1, Math.ceil((upper - lower) / 5));
  for (let k = Math.ceil(lower - 1e-9); k <= upper + 1e-9; k += every) found.push(k);
  return found;
}

// A plot of column `name`; `player` says what is shown and goes where it is told.
function makePlot(parent, name, label, player) {
  const figure = element("figure", parent, { className: "plot" });
  const head = element("h3", figure, {});
  element("span", head, { textContent: label });
  const value = element("output", head, {});
  const canvas = element("canvas", figure, { tabIndex: 0 });
  canvas.setAttribute("role", "img");
  const margin = { left: 62, right: 10, top: 8, bottom: 24 };
  let scale = null;

  function curves() {
    return player.logs.map((log, index) => {
      const column = log.columns.findIndex((one) => one.name === name), abscissa = player.abscissa(index);
      if (column < 0 || abscissa < 0) return [];
      const lift = player.isLogarithmic() ? (y) => (y > 0 ? Math.log10(y) : NaN) : (y) => y;
      return player.rows(index).map((row) => [row[abscissa], lift(row[column])]);
    });
  }

  const draw = oncePerPicture(() => {
    const ratio = fitCanvas(canvas), width = canvas.width / ratio, height = canvas.height / ratio;
    const pen = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
    const colour = (which) => style.getPropertyValue(which).trim();
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const all = curves(), ys = all.flat().map(([, y]) => y).filter(Number.isFinite);
    const [first, last] = player.range();
    let lower = ys.reduce((a, b) => Math.min(a, b), Infinity), upper = ys.reduce((a, b) => Math.max(a, b), -Infinity);
    if (!(lower <= upper)) [lower, upper] = [0, 1];
    if (upper - lower <= 1e-12 * Math.abs(upper)) [lower, upper] = [lower - (Math.abs(lower) || 1) * 0.05, upper + (Math.abs(upper) || 1) * 0.05];
    const room = 0.04 * (upper - lower);
    [lower, upper] = [lower - room, upper + room];
    const across = (x) => margin.left + (x - first) / (last - first || 1) * (width - margin.left - margin.right);
    const up = (y) => height - margin.bottom - (y - lower) / (upper - lower) * (height - margin.top - margin.bottom);
    scale = (pixel) => first + (pixel - margin.left) / (width - margin.left - margin.right) * (last - first);
    pen.font = "12px " + colour("--sans");
    pen.fillStyle = colour("--soft");
    pen.strokeStyle = colour("--rule");
    pen.lineWidth = 1;
    const marks = player.isLogarithmic() ? decades(lower, upper) : ticks(lower, upper, 4);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const y of marks) {
      pen.beginPath();
      pen.moveTo(margin.left, up(y));
      pen.lineTo(width - margin.right, up(y));
      pen.stroke();
      pen.fillText(number(player.isLogarithmic() ? 10 ** y : Math.abs(y) < 1e-9 * (upper - lower) ? 0 : y, 3), margin.left - 7, up(y));
    }
    pen.textBaseline = "top";
    for (const x of ticks(first, last, Math.max(2, width / 80))) {
      pen.textAlign = across(x) > width - 30 ? "right" : "center";
      pen.fillText(number(Math.abs(x) < 1e-9 * (last - first) ? 0 : x, 4), Math.min(across(x), width - 2), height - margin.bottom + 7);
    }
    drawCurves(pen, all, across, up, colour);
    const x = across(player.place());
    pen.strokeStyle = colour("--accent");
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(x, margin.top);
    pen.lineTo(x, height - margin.bottom);
    pen.stroke();
    tell(pen, across, up, colour);
  });

  function drawCurves(pen, all, across, up, colour) {
    all.forEach((curve, index) => {
      pen.strokeStyle = colour("--series-" + index);
      pen.lineWidth = 1.7;
      pen.setLineDash(index ? [7, 4] : []);
      pen.lineJoin = "round";
      pen.beginPath();
      let isDown = false;
      for (const [x, y] of curve) {
        // Recordings that are not full have no value in some columns: the line goes on to the next one.
        if (!Number.isFinite(y) || !Number.isFinite(x)) continue;
        if (isDown) pen.lineTo(across(x), up(y));
        else {
          pen.moveTo(across(x), up(y));
          isDown = true;
        }
      }
      pen.stroke();
    });
    pen.setLineDash([]);
  }

  // The exact values of the frames that are shown.
  function tell(pen, across, up, colour) {
    const values = player.logs.map((log, index) => {
      const row = player.row(index), column = log.columns.findIndex((one) => one.name === name);
      if (!row || column < 0) return "–";
      const y = player.isLogarithmic() ? Math.log10(row[column]) : row[column];
      if (Number.isFinite(y)) {
        pen.fillStyle = colour("--series-" + index);
        pen.beginPath();
        pen.arc(across(row[player.abscissa(index)]), up(y), 3.5, 0, 7);
        pen.fill();
      }
      return number(row[column], player.logs.length > 1 ? 4 : 5);
    });
    value.textContent = values.join(" · ");
    canvas.setAttribute("aria-label", `${label} against ${player.abscissaName()}; now ${values.join(" and ")}`);
  }

  const go = (event) => { if (scale) player.seek(scale(event.offsetX)); };
  canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); go(event); });
  canvas.addEventListener("pointermove", (event) => { if (event.buttons === 1) go(event); });
  new ResizeObserver(draw).observe(canvas);
  return { draw, remove: () => figure.remove() };
}
