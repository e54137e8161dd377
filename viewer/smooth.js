/// A mesh as its smooth surface: Loop's, at its limit. Borders are cubic B-splines between corners, which stay.

/// {x, index, tints} of the limit at the vertices of so many subdivisions, the mesh's own vertices first.
function smoothed({x, index, tints}, rounds) {
  for (let round = 0; round < rounds; ++round) ({x, index, tints} = subdivided(x, index, tints));
  return {x: moved(x, index, [2 / 3, 1 / 3], valence => valence === 3 ? [2 / 5, 3 / 5] : [1 / 2, 1 / 2]), index, tints};
}

/// The edges by their ends: {id, ends, opposite}, and of each vertex its number of triangles.
function topology(index, n) {
  const edges = new Map(), fans = new Uint16Array(n);
  for (let t = 0; t < index.length; t += 3)
    for (let k = 0; k < 3; ++k) {
      const a = index[t + k], b = index[t + (k + 1) % 3], key = Math.min(a, b) * n + Math.max(a, b);
      if (!edges.has(key)) edges.set(key, {id: n + edges.size, ends: [a, b], opposite: []});
      edges.get(key).opposite.push(index[t + (k + 2) % 3]);
      ++fans[a];
    }
  return {edges, fans};
}

/// Each vertex as a mean of itself and its neighbours, with weights [own, theirs]: on the border of its neighbours there.
function moved(x, index, border, inner) {
  const n = x.length / 3, {edges, fans} = topology(index, n), out = new Float32Array(x);
  const sums = [new Float64Array(4 * n), new Float64Array(4 * n)];  // of all neighbours, of those along the border; and how many
  for (const {ends: [a, b], opposite} of edges.values())
    for (const [v, w] of [[a, b], [b, a]])
      for (const sum of opposite.length === 1 ? sums : [sums[0]]) {
        for (let k = 0; k < 3; ++k) sum[4 * v + k] += x[3 * w + k];
        ++sum[4 * v + 3];
      }
  for (let v = 0; v < n; ++v) {
    const rim = sums[1][4 * v + 3], sum = rim ? sums[1] : sums[0], count = sum[4 * v + 3];
    if (!count || rim && (rim !== 2 || fans[v] < 3)) continue;  // a corner, or no manifold
    const [own, theirs] = rim ? border : inner(count);
    for (let k = 0; k < 3; ++k) out[3 * v + k] = own * x[3 * v + k] + theirs * sum[4 * v + k] / count;
  }
  return out;
}

function subdivided(x, index, tints) {
  const n = x.length / 3, {edges} = topology(index, n), id = (a, b) => edges.get(Math.min(a, b) * n + Math.max(a, b)).id;
  const vertices = moved(x, index, [3 / 4, 1 / 4], valence => { const own = valence === 3 ? 7 / 16 : 5 / 8; return [own, 1 - own]; });
  const all = new Float32Array(3 * (n + edges.size)), colours = tints && new Uint8Array(all.length), finer = new Uint32Array(4 * index.length);
  all.set(vertices);
  if (tints) colours.set(tints);
  for (const {id: e, ends: [a, b], opposite} of edges.values())
    for (let k = 0; k < 3; ++k) {
      const ends = x[3 * a + k] + x[3 * b + k];
      all[3 * e + k] = opposite.length === 2 ? 3 / 8 * ends + (x[3 * opposite[0] + k] + x[3 * opposite[1] + k]) / 8 : ends / 2;
      if (tints) colours[3 * e + k] = (tints[3 * a + k] + tints[3 * b + k]) / 2;
    }
  for (let t = 0; t < index.length; t += 3) {
    const [a, b, c] = index.subarray(t, t + 3), [ab, bc, ca] = [id(a, b), id(b, c), id(c, a)];
    finer.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], 4 * t);
  }
  return {x: all, index: finer, tints: colours};
}

/* global THREE */
/// The smooth surface of a coarse state, kept with its positions; nothing for a mesh that is fine already.
export function surface({index, x, tints}, colours) {
  const rounds = Math.min(2, Math.floor(Math.log(3 * 60000 / x.length) / Math.log(4)));
  if (rounds < 1) return null;
  x.surfaces ??= {};
  if (!x.surfaces[colours]) {
    const made = smoothed({x, index: index.array, tints}, rounds);
    x.surfaces[colours] = {...made, index: new THREE.BufferAttribute(made.index, 1)};
    made.x.rounding = x.rounding;
  }
  return x.surfaces[colours];
}
