// Rigid bodies as boxes or ellipsoids, with the axes of their frames.
import {
  AxesHelper, BoxGeometry, Group, Matrix4, Mesh, MeshStandardMaterial, SphereGeometry,
} from "three";
import { colourOfPoint } from "./colours.js";
import { principalAxes } from "./inertia.js";

// Return the matrix that takes a body's unit box, or unit ball, to its place in the body's frame.
function shapeMatrix({ spread, vectors: e }, centre, factor) {
  const [a, b, c] = spread.map((s) => factor * s);
  return new Matrix4().set(
    a * e[0][0], b * e[0][1], c * e[0][2], centre[0],
    a * e[1][0], b * e[1][1], c * e[1][2], centre[1],
    a * e[2][0], b * e[2][1], c * e[2][2], centre[2], 0, 0, 0, 1);
}

function makeBody(body, k, usual) {
  const group = new Group(), axes = principalAxes(body.moments, usual);
  const material = new MeshStandardMaterial({ color: colourOfPoint(k), roughness: 0.6 });
  const shapes = {
    box: new Mesh(new BoxGeometry(2, 2, 2), material),
    ellipsoid: new Mesh(new SphereGeometry(1, 32, 20), material),
  };
  const factor = { box: Math.sqrt(3), ellipsoid: Math.sqrt(5) };
  for (const [name, mesh] of Object.entries(shapes)) {
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(shapeMatrix(axes, body.moments.centre, factor[name]));
    group.add(mesh);
  }
  group.add(new AxesHelper(1.25 * factor.box * Math.max(...axes.spread)));
  group.matrixAutoUpdate = false;
  return { group, shapes };
}

// Add the bodies of a run to a scene. Rotations are [frames][bodies][9], row by row.
export function addBodies(scene, run, size) {
  // several bodies without places stand 1 apart
  const usual = run.bodies.length > 1 ? Math.min(0.2 * size, 0.4) : 0.2 * size;
  const made = run.bodies.map((body, k) => makeBody(body, k, usual));
  for (const { group } of made) scene.add(group);
  return {
    shape(name) {
      for (const { shapes } of made)
        for (const [other, mesh] of Object.entries(shapes)) mesh.visible = other === name;
    },
    show(frame) {
      made.forEach(({ group }, k) => {
        const at = 9 * (frame * made.length + k), R = run.rotations.subarray(at, at + 9);
        const { point } = run.bodies[k], p = 3 * (frame * run.points.length + point);
        const x = point < 0 ? [0, 0, 0] : run.positions.subarray(p, p + 3);
        group.matrix.set(R[0], R[1], R[2], x[0], R[3], R[4], R[5], x[1], R[6], R[7], R[8], x[2],
          0, 0, 0, 1);
        group.matrixWorldNeedsUpdate = true;
      });
    },
  };
}
