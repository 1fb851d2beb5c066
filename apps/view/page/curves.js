// Quantities over time, each in a panel: how far they are from their start, with a mark at the time
// that is shown.
import { rangeOf } from "./run.js";

const HEIGHT = 96, LEFT = 8, TOP = 34, BOTTOM = 8;

// Return the line of a curve in its panel, and the words above it.
function layOut(run, k, width) {
  const { name, first, changes } = run.curves[k], [least, most] = rangeOf(changes);
  const span = most - least || 1, path = new Path2D();
  const [begin, end] = [run.times[0], run.times[run.frames - 1]], reach = end - begin || 1;
  const xOf = (frame) => LEFT + (width - 2 * LEFT) * (run.times[frame] - begin) / reach;
  const yOf = (change) => HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (change - least) / span;
  for (let f = 0; f < run.frames; f++) path.lineTo(xOf(f), yOf(changes[f]));
  const words = [`${name}, from ${first.toPrecision(6)}`,
    `${least.toExponential(2)} to ${most.toExponential(2)}`];
  return { path, words, xOf, zero: yOf(0) };
}

export function createCurves(run, canvas) {
  const ratio = window.devicePixelRatio, width = canvas.clientWidth || 300;
  const panels = run.curves.map((_, k) => layOut(run, k, width)), ink = canvas.getContext("2d");
  canvas.width = width * ratio;
  canvas.height = HEIGHT * panels.length * ratio;
  canvas.style.height = `${HEIGHT * panels.length}px`;
  return (frame) => {
    ink.setTransform(ratio, 0, 0, ratio, 0, 0);
    ink.clearRect(0, 0, width, HEIGHT * panels.length);
    for (const { path, words, xOf, zero } of panels) {
      ink.font = "12px sans-serif";
      ink.fillStyle = "#222";
      ink.fillText(words[0], LEFT, 14);
      ink.fillStyle = "#777";
      ink.fillText(words[1], LEFT, 28);
      ink.lineWidth = 1;
      ink.strokeStyle = "#ccc";
      ink.strokeRect(LEFT, zero, width - 2 * LEFT, 0);
      ink.strokeStyle = "#4477aa";
      ink.stroke(path);
      ink.strokeStyle = "#ee6677";
      ink.strokeRect(xOf(frame), TOP - 2, 0, HEIGHT - TOP - BOTTOM + 4);
      ink.translate(0, HEIGHT);
    }
  };
}
