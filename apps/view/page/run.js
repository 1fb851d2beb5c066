// The run that a page carries: JSON, whose long lists are the bytes of numbers in base64.

function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
}

function revive(key, value) {
  if (typeof value?.floats === "string") return new Float32Array(bytesOf(value.floats));
  if (typeof value?.integers === "string") return new Int32Array(bytesOf(value.integers));
  return value;
}

export function readRun() {
  return JSON.parse(document.getElementById("run").textContent, revive);
}

// Grow a box {least, most} by points [.. x, y, z ..].
export function growBox(box, points) {
  for (let i = 0; i < points.length; i++) {
    const axis = i % 3;
    box.least[axis] = Math.min(box.least[axis], points[i]);
    box.most[axis] = Math.max(box.most[axis], points[i]);
  }
}

// Return the least and the most of some numbers.
export function rangeOf(numbers) {
  let least = Infinity, most = -Infinity;
  for (const x of numbers) {
    if (x < least) least = x;
    if (x > most) most = x;
  }
  return [least, most];
}
