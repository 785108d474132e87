// Grains by WebGL: a square for each, cut to a disk or a ball of true diameter. What is known of them stands in textures, from
// which each corner takes its own: one call draws all, which is as fast by software as it can be.
const LEAST_RADIUS = 0.9; // smaller grains could not be seen [pixel]

const ROW = 1024; // grains in a row of a texture

const VERTEX = `#version 300 es
#define ROW ${ROW}
precision highp float;
precision highp sampler2D;
uniform sampler2D grains, diameters;
uniform bool mixture;
uniform float usual;
uniform vec3 centre, right, up, away;
uniform vec2 size, shift, range;
uniform float scale, least, depth;
uniform bool logarithmic;
out vec2 at;
out float share, radius, far;
void main() {
  int number = gl_VertexID / 6, which = gl_VertexID % 6;
  ivec2 texel = ivec2(number % ROW, number / ROW);
  vec4 grain = texelFetch(grains, texel, 0);
  float value = grain.w, diameter = mixture ? texelFetch(diameters, texel, 0).r : usual;
  vec2 corner = vec2(which == 1 || which == 2 || which == 4 ? 1.0 : -1.0, which == 2 || which == 4 || which == 5 ? 1.0 : -1.0);
  vec3 from = grain.xyz - centre;
  radius = max(0.5 * diameter * scale, least);
  at = corner * (radius + 1.0);
  vec2 screen = scale * vec2(dot(right, from), dot(up, from)) + vec2(shift.x, -shift.y) + at;
  far = dot(away, from) / depth;
  float lifted = logarithmic ? log(max(value, 1e-30)) : value;
  share = isnan(value) ? -1.0 : clamp((lifted - range.x) / (range.y - range.x), 0.0, 1.0);
  gl_Position = vec4(2.0 * screen / size, clamp(1.8 * far, -0.98, 0.98), 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec2 at;
in float share, radius, far;
uniform sampler2D map;
uniform vec3 paper, unknown;
uniform bool deep;
uniform float scale, depth;
out vec4 colour;
void main() {
  float middle = length(at);
  float cover = clamp(radius - middle + 0.5, 0.0, 1.0);
  if (cover <= 0.0) discard;
  vec3 own = share < 0.0 ? unknown : texture(map, vec2(0.5 / 64.0 + share * 63.0 / 64.0, 0.5)).rgb;
  float bulge = sqrt(max(0.0, 1.0 - middle * middle / (radius * radius)));
  if (deep) {
    vec3 normal = vec3(at / radius, bulge);
    float light = radius > 2.0 ? 0.66 + 0.34 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.55, 0.76)))) : 0.9;
    own = mix(own * light, paper, 0.62 * clamp(0.5 + far, 0.0, 1.0));
    gl_FragDepth = clamp(gl_FragCoord.z - 0.9 * bulge * radius / (scale * depth), 0.0, 1.0);
  } else {
    gl_FragDepth = 0.5;
    if (radius > 3.0) own *= 1.0 - 0.35 * smoothstep(radius - 1.6, radius - 0.4, middle);
  }
  colour = vec4(own, 1.0) * cover;
}`;

// A painter that draws into `canvas`, or nothing where there is no WebGL.
function glPainter(canvas) {
  const gl = canvas.getContext("webgl2", { alpha: true, premultipliedAlpha: true, antialias: true, preserveDrawingBuffer: true });
  if (!gl) return null;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  gl.useProgram(program);
  const at = (name) => gl.getUniformLocation(program, name);
  const names = ["centre", "right", "up", "away", "size", "shift", "range", "scale", "least", "depth", "logarithmic", "map", "paper", "unknown", "deep", "grains", "diameters", "mixture", "usual"];
  const places = Object.fromEntries(names.map((name) => [name, at(name)]));
  const textures = ["grains", "diameters", "map"].map((name, unit) => {
    gl.uniform1i(places[name], unit);
    return gl.createTexture();
  });
  let loaded = null, loadedValues = null, loadedMap = null;

  // Fills a texture of numbers, `each` to a grain.
  function numbers(unit, each, count, fill) {
    const rows = Math.max(1, Math.ceil(count / ROW)), data = new Float32Array(each * ROW * rows);
    fill(data);
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, textures[unit]);
    gl.texImage2D(gl.TEXTURE_2D, 0, each === 4 ? gl.RGBA32F : gl.R32F, ROW, rows, 0, each === 4 ? gl.RGBA : gl.RED, gl.FLOAT, data);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
  }

  function load(frame, values, map) {
    if (loaded !== frame || loadedValues !== values) {
      numbers(0, 4, frame.points, (data) => {
        for (let k = 0; k < frame.points; k++) {
          for (let axis = 0; axis < frame.axes; axis++) data[4 * k + axis] = frame.places[frame.axes * k + axis];
          data[4 * k + 3] = values[k];
        }
      });
      numbers(1, 1, frame.diameters ? frame.points : 1, (data) => { if (frame.diameters) data.set(frame.diameters); });
      [loaded, loadedValues] = [frame, values];
    }
    if (loadedMap === map) return;
    const texels = new Uint8Array(map.flatMap((colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16)).concat(255)));
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, textures[2]);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, map.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, texels);
    for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
    for (const way of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, way, gl.CLAMP_TO_EDGE);
    loadedMap = map;
  }

  const unit = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16) / 255);

  function paint({ frame, log, eye, ratio, values, range, logarithmic, map }) {
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!frame || frame.points === 0) return;
    load(frame, values, map);
    if (log.deep) {
      gl.enable(gl.DEPTH_TEST);
      gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      gl.disable(gl.BLEND);
    } else {
      gl.disable(gl.DEPTH_TEST);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    }
    for (const name of ["centre", "right", "up", "away"]) gl.uniform3fv(places[name], eye[name]);
    gl.uniform2f(places.size, canvas.width, canvas.height);
    gl.uniform2f(places.shift, eye.shift[0] * ratio, eye.shift[1] * ratio);
    gl.uniform2fv(places.range, range);
    gl.uniform1f(places.scale, eye.scale * ratio);
    gl.uniform1f(places.least, LEAST_RADIUS * ratio);
    gl.uniform1f(places.depth, eye.depth);
    gl.uniform1i(places.logarithmic, logarithmic ? 1 : 0);
    gl.uniform1i(places.deep, log.deep ? 1 : 0);
    gl.uniform1i(places.mixture, frame.diameters ? 1 : 0);
    gl.uniform1f(places.usual, log.diameter);
    gl.uniform3fv(places.paper, unit(PAPER));
    gl.uniform3fv(places.unknown, unit(UNKNOWN));
    gl.drawArrays(gl.TRIANGLES, 0, 6 * frame.points);
  }
  paint.isFast = true;
  return paint;
}
