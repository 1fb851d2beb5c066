// The principal axes of a body, from its second moments S, the integral of x x^T over its mass.

// Diagonalise a symmetric 3 x 3 matrix by Jacobi's rotations. Returns its eigenvalues, and the
// eigenvectors as columns of a matrix, row by row.
function diagonalise(matrix) {
  const a = matrix.map((row) => row.slice()), e = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < 20; sweep++)
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      if (a[p][q] === 0) continue;
      const angle = Math.atan2(2 * a[p][q], a[q][q] - a[p][p]) / 2;
      const c = Math.cos(angle), s = Math.sin(angle);
      for (const m of [a, e])
        for (const row of m)
          [row[p], row[q]] = [c * row[p] - s * row[q], s * row[p] + c * row[q]];
      for (let k = 0; k < 3; k++)
        [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
    }
  return { values: [a[0][0], a[1][1], a[2][2]], vectors: e };
}

// Return the axes of a body with the moments [xx, xy, xz, yy, yz, zz] of its mass: of a box its
// half edges are sqrt(3 s), and of an ellipsoid its half axes sqrt(5 s). A body whose mass is not
// known is scaled to the size `usual`. Axes of flat bodies are not quite 0, so that they are seen.
export function principalAxes(moments, usual) {
  const [xx, xy, xz, yy, yz, zz] = moments.second, { mass } = moments;
  const { values, vectors } = diagonalise([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
  let spread = values.map((s) => Math.sqrt(Math.max(s, 0) / (mass || 1)));
  const longest = Math.max(...spread) || 1;
  const scale = mass > 0 && longest < 1e3 * usual ? 1 : usual / (Math.sqrt(3) * longest);
  spread = spread.map((s) => scale * Math.max(s, 0.02 * longest));
  // a right-handed frame, so that faces look outwards
  const [a, b, c] = vectors;
  const determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
    a[2] * (b[0] * c[1] - b[1] * c[0]);
  if (determinant < 0) for (const row of vectors) row[2] = -row[2];
  return { spread, vectors };
}
