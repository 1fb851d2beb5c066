// Colours of points and of fields.

const points = [0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377, 0x999999];

export function colourOfPoint(k) {
  return points[k % points.length];
}

// Stops of the two maps, in red, green and blue: values of both signs from blue by white to red,
// with white at 0, and those of one sign from dark to light.
const bothSigns = [[0.13, 0.27, 0.6], [0.55, 0.7, 0.9], [0.97, 0.97, 0.97], [0.95, 0.6, 0.5],
  [0.7, 0.09, 0.17]];
const oneSign = [[0.2, 0.05, 0.35], [0.2, 0.32, 0.55], [0.13, 0.57, 0.55], [0.45, 0.78, 0.38],
  [0.99, 0.9, 0.15]];

const SHADES = 256;

// Return the shades between stops, three numbers each.
function shadesOf(stops) {
  const shades = new Float32Array(3 * (SHADES + 1));
  for (let n = 0; n <= SHADES; n++) {
    const place = (stops.length - 1) * n / SHADES, k = Math.min(Math.floor(place), stops.length - 2);
    for (let i = 0; i < 3; i++)
      shades[3 * n + i] = stops[k][i] + (place - k) * (stops[k + 1][i] - stops[k][i]);
  }
  return shades;
}

// Return a function that writes the colour of a value into an array, in the linear numbers that
// light is computed with. Its `shades` are those of a screen.
export function colourMap(least, most) {
  const signed = least < 0 && most > 0, shades = shadesOf(signed ? bothSigns : oneSign);
  const from = signed ? -Math.max(-least, most) : least, to = signed ? -from : most;
  const scale = to > from ? SHADES / (to - from) : 0, linear = shades.map((c) => c ** 2.2);
  const map = (value, colour, at) => {
    const n = 3 * Math.round(Math.min(Math.max((value - from) * scale, 0), SHADES));
    for (let i = 0; i < 3; i++) colour[at + i] = linear[n + i];
  };
  return Object.assign(map, { from, to, shades });
}

// Draw the map with its ends into a canvas.
export function drawLegend(canvas, map) {
  const ink = canvas.getContext("2d"), bar = canvas.width;
  ink.clearRect(0, 0, canvas.width, canvas.height);
  for (let x = 0; x < bar; x++) {
    const n = 3 * Math.round(SHADES * x / bar), shade = map.shades.slice(n, n + 3);
    ink.fillStyle = `rgb(${shade.map((c) => Math.round(255 * c)).join()})`;
    ink.fillRect(x, 0, 1, 12);
  }
  ink.fillStyle = "#222";
  ink.font = "11px sans-serif";
  ink.textAlign = "left";
  ink.fillText(map.from.toPrecision(3), 0, 25);
  ink.textAlign = "right";
  ink.fillText(map.to.toPrecision(3), bar, 25);
}
