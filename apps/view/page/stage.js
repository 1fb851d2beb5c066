// The drawing of a run: what moves, the light, and the eye.
import {
  AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { addBodies } from "./bodies.js";
import { addField } from "./field.js";
import { addPoints } from "./points.js";
import { principalAxes } from "./inertia.js";
import { growBox } from "./run.js";

const FIELD_OF_VIEW = 35;

// Grow a box by a body of known mass, however it is turned, where its place begins.
function growByBody(box, run, { point, moments }) {
  if (!(moments.mass > 0)) return;
  const reach = Math.sqrt(5) * Math.max(...principalAxes(moments, 1).spread);
  const x = point < 0 ? [0, 0, 0] : run.positions.subarray(3 * point, 3 * point + 3);
  for (const way of [-reach, reach]) growBox(box, Array.from(x, (place) => place + way));
}

// Return the middle and the size of all that is drawn.
function findExtent(run) {
  const box = { least: [Infinity, Infinity, Infinity], most: [-Infinity, -Infinity, -Infinity] };
  if (run.points.length > 0) growBox(box, run.positions);
  if (run.mesh) growBox(box, run.mesh.points);
  for (const body of run.bodies) growByBody(box, run, body);
  if (run.links.some((link) => link.includes(-1)) || run.bodies.some((b) => b.point < 0))
    growBox(box, [0, 0, 0]);
  const middle = new Vector3(...box.least.map((least, i) => (least + box.most[i]) / 2));
  const size = Math.hypot(...box.most.map((most, i) => most - box.least[i]));
  return { middle, size: size > 0 ? size : 1 };
}

// Place the eye: above a plane, aside of a space with z up, and aside of a plane with heights.
function placeEye(camera, controls, { middle, size }, isPlane, hasHeights) {
  const distance = 0.55 * size / Math.tan(FIELD_OF_VIEW * Math.PI / 360);
  const towards = !isPlane ? new Vector3(0.55, -0.75, 0.4)
    : hasHeights ? new Vector3(0, -0.8, 0.6) : new Vector3(0, 0, 1);
  camera.near = distance / 1000;
  camera.far = 50 * distance;
  camera.position.copy(middle).addScaledVector(towards.normalize(), distance);
  controls.target.copy(middle);
  controls.update();
}

export function createStage(run, canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true });
  const scene = new Scene(), camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 10);
  camera.up.set(0, run.isPlane ? 1 : 0, run.isPlane ? 0 : 1); // before the controls, which copy it
  const controls = new OrbitControls(camera, canvas), extent = findExtent(run);
  scene.background = new Color(0xffffff);
  scene.add(new AmbientLight(0xffffff, 1.4));
  const lamp = new DirectionalLight(0xffffff, 2);
  camera.add(lamp);
  lamp.position.set(0.4, 0.6, 1);
  scene.add(camera);
  const stage = { controls, camera, parts: [] };
  if (run.points.length > 0) stage.points = addPoints(scene, run, extent.size);
  if (run.bodies.length > 0) stage.bodies = addBodies(scene, run, extent.size);
  if (run.mesh) stage.field = addField(scene, run, extent.size);
  stage.parts = [stage.points, stage.bodies, stage.field].filter((part) => part);
  stage.show = (frame) => {
    for (const part of stage.parts) part.show(frame);
    stage.draw();
  };
  stage.placeEye = (hasHeights) => placeEye(camera, controls, extent, run.isPlane, hasHeights);
  stage.placeEye(false);
  stage.draw = () => renderer.render(scene, camera);
  stage.resize = (width, height) => {
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    stage.draw();
  };
  return stage;
}
