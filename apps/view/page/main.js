// The page: its controls, and the clock that plays the run.
import { createCurves } from "./curves.js";
import { drawLegend } from "./colours.js";
import { readRun } from "./run.js";
import { createStage } from "./stage.js";

const SECONDS = 10; // of the whole run at speed 1

const element = (id) => document.getElementById(id);
const reveal = (id) => element(id).closest("label").hidden = false;

function start(run) {
  const stage = createStage(run, element("stage")), drawCurves = createCurves(run, element("curves"));
  const slider = element("slider"), play = element("play");
  const begin = run.times[0], end = run.times[run.frames - 1];
  let frame = -1, playing = false, time = begin, before;

  // Find the last frame up to a time. Times go forward or backward.
  const frameAt = (t) => {
    let low = 0, high = run.frames - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if ((run.times[middle] - t) * (end - begin) <= 0) low = middle;
      else high = middle - 1;
    }
    return low;
  };
  const show = (next) => {
    frame = next;
    slider.value = frame;
    element("time").textContent = `t = ${run.times[frame].toPrecision(6)}`;
    document.body.dataset.frame = frame;
    stage.show(frame);
    drawCurves(frame);
  };
  const setPlaying = (now) => {
    playing = now;
    play.textContent = playing ? "Pause" : "Play";
    if (!playing) return;
    if (frame === run.frames - 1) show(0);
    time = run.times[frame];
    before = undefined;
    requestAnimationFrame(tick);
  };
  const tick = (now) => {
    if (!playing) return;
    const passed = (now - (before ?? now)) / (1000 * SECONDS);
    time += (end - begin) * element("speed").value * passed;
    before = now;
    const next = frameAt(time);
    if (next !== frame) show(next);
    if (next === run.frames - 1) setPlaying(false);
    else requestAnimationFrame(tick);
  };

  slider.max = run.frames - 1;
  slider.addEventListener("input", () => {
    setPlaying(false);
    show(Number(slider.value));
  });
  play.addEventListener("click", () => setPlaying(!playing));
  stage.controls.addEventListener("change", () => {
    document.body.dataset.eye = stage.camera.position.toArray().map((x) => x.toFixed(3)).join();
    stage.draw();
  });
  const resize = () => stage.resize(element("stage").clientWidth, element("stage").clientHeight);
  window.addEventListener("resize", resize);
  connectParts(run, stage, () => show(Math.max(frame, 0)));
  element("title").textContent = run.title;
  element("made").textContent = run.made;
  resize();
  show(0);
}

// Connect the controls of what the run has. The others stay hidden.
function connectParts(run, stage, again) {
  const { points, bodies, field } = stage;
  if (points?.hasTrails) {
    const trails = element("trails"), set = () => points.trails(trails.checked);
    reveal("trails");
    trails.checked = run.trails;
    trails.addEventListener("change", () => { set(); again(); });
    set();
  }
  if (bodies) {
    const shape = element("shape");
    reveal("shape");
    shape.addEventListener("change", () => { bodies.shape(shape.value); again(); });
    bodies.shape(shape.value);
  }
  if (field) {
    const choice = element("field"), raised = element("raised");
    const choose = () => {
      field.choose(choice.selectedIndex);
      drawLegend(element("legend"), field.map());
    };
    for (const { name } of run.mesh.fields) choice.add(new Option(name));
    reveal("field");
    element("legend").hidden = run.mesh.isLine;
    choice.addEventListener("change", () => { choose(); again(); });
    choose();
    if (field.canRise && !run.mesh.isLine && !run.mesh.moves) {
      reveal("raised");
      raised.addEventListener("change", () => {
        field.raise(raised.checked);
        stage.placeEye(raised.checked);
        again();
      });
    }
  }
}

try {
  start(readRun());
} catch (error) {
  element("trouble").textContent = `This page cannot be drawn: ${error.message}`;
  throw error;
}
