// Presses the controls of a page of dvi view as a reader would, and writes what it sees to the end
// of the page: a line for each, and the picture as the mean colours of 24 x 16 fields. The clock is
// its own, so that nothing depends on the machine's.
(() => {
  const element = (id) => document.getElementById(id), lines = [];
  const say = (what, value) => lines.push(`${what}: ${value}`);
  const frame = () => Number(document.body.dataset.frame), last = Number(element("slider").max);
  let clock = 0, due = [];
  window.requestAnimationFrame = (call) => due.push(call);
  const pass = (seconds) => {
    for (const end = clock + 1000 * seconds; clock < end;) {
      const calls = due;
      due = [];
      clock += 20;
      for (const call of calls) call(clock);
    }
  };
  const change = (id, key, value, event) => {
    element(id)[key] = value;
    element(id).dispatchEvent(new Event(event));
  };
  // Drawn at once after a change, since the canvas is empty later.
  const picture = () => {
    const small = new OffscreenCanvas(24, 16), ink = small.getContext("2d");
    ink.imageSmoothingQuality = "high";
    ink.drawImage(element("stage"), 0, 0, 24, 16);
    return Array.from(ink.getImageData(0, 0, 24, 16).data).filter((_, i) => i % 4 < 3);
  };
  const difference = (a, b) => a.reduce((sum, x, i) => sum + Math.abs(x - b[i]), 0) / a.length;
  const drag = () => {
    const stage = element("stage"), box = stage.getBoundingClientRect();
    const at = (type, x) => stage.dispatchEvent(new PointerEvent(type, { bubbles: true,
      pointerId: 1, pointerType: "mouse", button: 0, buttons: 1,
      clientX: box.left + 100 + x, clientY: box.top + 100 }));
    stage.setPointerCapture = stage.releasePointerCapture = () => {};
    at("pointerdown", 0);
    at("pointermove", 60);
    at("pointerup", 60);
  };

  say("trouble", element("trouble").textContent || "none");
  say("title", element("title").textContent);
  say("frames", last + 1);
  for (const id of ["trails", "shape", "field", "raised"])
    say(id, element(id).offsetParent !== null ? "shown" : "hidden");

  element("play").click();
  say("pressed play", element("play").textContent);
  pass(2);
  element("play").click();
  const paused = frame();
  say("played", Math.abs(paused - last / 5) <= Math.max(1, last / 100));
  pass(1);
  say("paused", frame() === paused);
  change("speed", "value", "3", "change");
  element("play").click();
  pass(1);
  say("faster", Math.abs(frame() - last / 2) <= Math.max(1, last / 20));
  pass(3);
  say("at the end", frame() === last);
  say("then", element("play").textContent);
  say("last time", element("time").textContent);

  change("slider", "value", Math.floor(last / 2), "input");
  say("slid", frame() === Math.floor(last / 2));
  const before = picture();
  say("picture", before.join(" "));
  for (const [id, key, value] of [["trails", "checked", !element("trails").checked],
    ["shape", "value", "ellipsoid"], ["raised", "checked", true]]) {
    if (element(id).offsetParent === null) continue;
    const was = element(id)[key];
    change(id, key, value, "change");
    say(`${id} changes the picture`, difference(before, picture()) > 0.02);
    change(id, key, was, "change");
    say(`${id} changes it back`, difference(before, picture()) < 0.01);
  }
  const eye = document.body.dataset.eye;
  drag();
  say("the eye turned", eye !== document.body.dataset.eye);

  const report = document.createElement("pre");
  report.id = "report";
  report.textContent = lines.join("\n");
  document.body.append(report);
})();
