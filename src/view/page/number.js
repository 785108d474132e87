// Numbers as everywhere in the house: significant digits, groups of three, powers of ten.
const byId = (id) => document.getElementById(id);
const PAPER = "#f7f5f0", WALL = "#3c3a36", PERIODIC = "#b9b3a5", UNKNOWN = "#a9a59c";

function number(value, digits) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const power = Number(value.toExponential(digits - 1).split("e")[1]);
  if (power < -4 || (power >= 6 && digits < 15)) {
    const raised = String(power).replace(/./g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻");
    return (Number((value / 10 ** power).toPrecision(digits)) + " × 10" + raised).replace("-", "−");
  }
  const [whole, fraction] = Number(value.toPrecision(digits)).toFixed(Math.max(0, Math.min(20, digits - 1 - power))).split(".");
  const grouped = whole.replace("-", "").length < 5 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, "\u202f");
  const rest = (fraction || "").replace(/0+$/, "");
  return grouped.replace("-", "−") + (rest ? "." + rest : "");
}

function element(name, parent, properties) {
  const made = Object.assign(document.createElement(name), properties);
  parent.append(made);
  return made;
}

// A canvas with as many pixels as the screen has; returns pixels per unit of CSS.
function fitCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  return ratio;
}

// `work`, once before the next picture however often it is asked for.
function oncePerPicture(work) {
  let isDue = false;
  return () => {
    if (isDue) return;
    isDue = true;
    requestAnimationFrame(() => {
      isDue = false;
      work();
    });
  };
}
