// Points as balls, what links them as rods, and their trails.
import {
  BufferAttribute, BufferGeometry, CylinderGeometry, InstancedMesh, Line, LineBasicMaterial,
  MeshStandardMaterial, Object3D, SphereGeometry, Vector3, Color,
} from "three";
import { colourOfPoint } from "./colours.js";

const TRAILS_MOST = 300;

function addBalls(scene, run, size) {
  const count = run.points.length, radius = size * Math.min(0.02, 0.25 / Math.cbrt(count + 1) ** 2);
  const rings = count > TRAILS_MOST ? 6 : 14;
  const balls = new InstancedMesh(new SphereGeometry(radius, rings + 6, rings),
    new MeshStandardMaterial({ roughness: 0.5 }), count);
  for (let k = 0; k < count; k++) balls.setColorAt(k, new Color(colourOfPoint(k)));
  balls.frustumCulled = false;
  scene.add(balls);
  return { balls, radius };
}

function addRods(scene, run, radius) {
  const rods = new InstancedMesh(new CylinderGeometry(radius, radius, 1, 8),
    new MeshStandardMaterial({ color: 0x777777 }), run.links.length);
  rods.frustumCulled = false;
  scene.add(rods);
  return rods;
}

// Copy the path of a point, which a line can be drawn along up to any frame.
function addTrail(scene, run, k) {
  const count = run.points.length, path = new Float32Array(3 * run.frames);
  for (let f = 0; f < run.frames; f++)
    path.set(run.positions.subarray(3 * (f * count + k), 3 * (f * count + k) + 3), 3 * f);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(path, 3));
  const line = new Line(geometry, new LineBasicMaterial({ color: colourOfPoint(k) }));
  line.frustumCulled = false;
  scene.add(line);
  return line;
}

// Add the points of a run to a scene. Positions are [frames][points][3].
export function addPoints(scene, run, size) {
  const count = run.points.length, { balls, radius } = addBalls(scene, run, size);
  const rods = addRods(scene, run, 0.3 * radius), place = new Object3D();
  const trails = count <= TRAILS_MOST ? run.points.map((_, k) => addTrail(scene, run, k)) : [];
  const origin = new Vector3(), up = new Vector3(0, 1, 0);
  const pointAt = (frame, k) => k < 0 ? origin
    : new Vector3().fromArray(run.positions, 3 * (frame * count + k));
  const showBalls = (frame) => {
    place.scale.set(1, 1, 1);
    place.quaternion.identity();
    for (let k = 0; k < count; k++) {
      place.position.copy(pointAt(frame, k));
      place.updateMatrix();
      balls.setMatrixAt(k, place.matrix);
    }
    balls.instanceMatrix.needsUpdate = true;
  };
  const showRods = (frame) => {
    run.links.forEach(([a, b], k) => {
      const from = pointAt(frame, a), along = pointAt(frame, b).clone().sub(from);
      const length = along.length();
      place.position.copy(from).addScaledVector(along, 0.5);
      place.quaternion.setFromUnitVectors(up, length > 0 ? along.divideScalar(length) : up);
      place.scale.set(1, length || 1e-9, 1);
      place.updateMatrix();
      rods.setMatrixAt(k, place.matrix);
    });
    rods.instanceMatrix.needsUpdate = true;
  };
  return {
    hasTrails: trails.length > 0,
    trails(visible) {
      for (const line of trails) line.visible = visible;
    },
    show(frame) {
      showBalls(frame);
      showRods(frame);
      for (const line of trails) line.geometry.setDrawRange(0, frame + 1);
    },
  };
}
