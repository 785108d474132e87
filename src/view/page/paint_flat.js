// Grains without WebGL: slower, and the same to look at as far as a plain canvas can.
const HAZES = 8; // steps from near to far, where colours turn to paper

function flatPainter(canvas) {
  const pen = canvas.getContext("2d");
  let hazy = null, hazyOf = null;

  function blend(first, second, share) {
    const channel = (colour, k) => parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16);
    return `rgb(${[0, 1, 2].map((k) => Math.round((1 - share) * channel(first, k) + share * channel(second, k))).join(",")})`;
  }

  return function paint({ frame, log, eye, ratio, values, range, logarithmic, map }) {
    const width = canvas.width / ratio, height = canvas.height / ratio;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    if (!frame) return;
    if (hazyOf !== map) {
      const all = map.concat(UNKNOWN);
      hazy = Array.from({ length: HAZES }, (_, k) => all.map((colour) => blend(colour, PAPER, 0.62 * k / (HAZES - 1))));
      hazyOf = map;
    }
    const colourOf = (value) => {
      if (Number.isNaN(value)) return map.length;
      const share = ((logarithmic ? Math.log(Math.max(value, 1e-30)) : value) - range[0]) / (range[1] - range[0]);
      return Math.max(0, Math.min(map.length - 1, Math.floor(share * map.length)));
    };
    const grains = [];
    for (let k = 0; k < frame.points; k++) {
      const place = frame.places.subarray(frame.axes * k, frame.axes * (k + 1));
      const [x, y, far] = projected(eye, place, width, height);
      const radius = Math.max(LEAST_RADIUS, 0.5 * (frame.diameters ? frame.diameters[k] : log.diameter) * eye.scale);
      const haze = log.deep ? Math.round(Math.max(0, Math.min(1, 0.5 + far)) * (HAZES - 1)) : 0;
      grains.push({ x, y, far, radius, fill: hazy[haze][colourOf(values[k])] });
    }
    if (log.deep) grains.sort((a, b) => b.far - a.far);
    pen.lineWidth = 0.7;
    pen.strokeStyle = "rgba(30, 20, 40, 0.35)";
    for (const { x, y, radius, fill } of grains) {
      pen.fillStyle = fill;
      pen.beginPath();
      pen.arc(x, y, radius, 0, 7);
      pen.fill();
      if (radius > 3) pen.stroke();
    }
  };
}
