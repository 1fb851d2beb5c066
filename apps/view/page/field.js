// A field on a mesh, in colours, and as heights if it is flat.
import {
  BufferAttribute, BufferGeometry, DoubleSide, LineBasicMaterial, LineSegments, Mesh,
  MeshBasicMaterial, MeshLambertMaterial,
} from "three";
import { colourMap } from "./colours.js";
import { rangeOf } from "./run.js";

const lineColour = [0.05, 0.19, 0.42]; // values show as heights

// Add the mesh of a run to a scene: triangles, or lines of a mesh of one dimension. Each corner has
// a place and a colour of its own, because values may jump from cell to cell.
export function addField(scene, run, size) {
  const { mesh } = run, { corners, cells, isLine } = mesh, count = corners.length;
  const perCell = isLine ? 2 : 3;
  const geometry = new BufferGeometry(), place = new Float32Array(3 * count);
  const colour = new Float32Array(3 * count);
  geometry.setAttribute("position", new BufferAttribute(place, 3));
  geometry.setAttribute("color", new BufferAttribute(colour, 3));
  const look = { vertexColors: true, side: DoubleSide }, flat = new MeshBasicMaterial(look);
  const lit = new MeshLambertMaterial({ ...look, flatShading: true });
  const drawn = isLine
    ? new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true }))
    : new Mesh(geometry, mesh.isFlat ? flat : lit);
  drawn.frustumCulled = false;
  scene.add(drawn);
  const pointCount = mesh.pointCount, raised = mesh.isFlat ? (isLine ? 1 : 2) : -1;
  let field, map, height;
  const state = { isRaised: raised === 1 };
  return {
    canRise: raised >= 0,
    map: () => map,
    choose(k) {
      field = mesh.fields[k];
      const [least, most] = rangeOf(field.values);
      map = colourMap(least, most);
      height = 0.25 * size / (Math.max(Math.abs(least), Math.abs(most)) || 1);
    },
    raise(isRaised) {
      state.isRaised = isRaised;
      drawn.material = isRaised ? lit : flat;
    },
    show(frame) {
      const points = mesh.moves ? 3 * pointCount * frame : 0;
      const width = field.values.length / run.frames, first = width * frame;
      for (let i = 0; i < count; i++) {
        const index = field.isByCell ? cells[Math.floor(i / perCell)] : corners[i];
        const value = field.values[first + index], at = points + 3 * corners[i];
        for (let axis = 0; axis < 3; axis++) place[3 * i + axis] = mesh.points[at + axis];
        if (state.isRaised && raised >= 0) place[3 * i + raised] += height * value;
        if (raised === 1) colour.set(lineColour, 3 * i);
        else map(value, colour, 3 * i);
      }
      geometry.attributes.position.needsUpdate = true;
      geometry.attributes.color.needsUpdate = true;
    },
  };
}
