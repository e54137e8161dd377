/// The viewer's blocks of bytes (docs/contributing/working.md), and its colours.

/// A block of this page; it is unpacked at its first use.
export async function embedded(name) {
  const packed = Uint8Array.from(atob(document.getElementById('viewer-' + name).textContent), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

/// `rounding` is the most by which a coordinate differs from the state's: half a step, and far from the origin what float32 leaves out.
export function positions(buffer, count) {
  const box = new Float32Array(buffer, 0, 6), steps = new Uint16Array(buffer, 24, 3 * count);
  const x = new Float32Array(3 * count);
  for (let k = 0; k < 3; ++k) {
    const lower = box[k], scale = box[3 + k] / 65535;
    for (let i = 0, q = 0; i < count; ++i) {
      q = (q + steps[k * count + i]) & 65535;
      x[3 * i + k] = lower + q * scale;
    }
  }
  const largest = Math.max(...[0, 1, 2].flatMap(k => [Math.abs(box[k]), Math.abs(box[k] + box[3 + k])]));
  x.rounding = Math.max(...box.slice(3)) / 65535 / 2 + largest / 2 ** 23;
  return x;
}

export function triangles(buffer, count) {
  const steps = new Int32Array(buffer, 0, 3 * count), index = new Uint32Array(3 * count);
  for (let k = 0; k < 3; ++k) {
    for (let t = 0, v = 0; t < count; ++t) index[3 * t + k] = v += steps[k * count + t];
  }
  return index;
}

/// {low, high, steps}: value = low + step (high − low) / 254; step 255 stands for none.
export function scalars(buffer) {
  const ends = new Float32Array(buffer, 0, 2);
  return {low: ends[0], high: ends[1], steps: new Uint8Array(buffer, 8)};
}

/// Colour maps: sRGB at equal distances; RdBu, viridis and one of lightness for forces.
const rgb = text => text.split(' ').map(c => [1, 3, 5].map(k => parseInt(c.slice(k, k + 2), 16)));
const viridis = '#440154 #472d7b #3b528b #2c728e #21918c #28ae80 #5ec962 #addc30 #fde725';
const maps = {
  diverging: rgb('#053061 #2166ab #4393c3 #92c5de #f7f7f7 #f4a582 #d64d4d #b2182b #67001f'),
  sequential: rgb(viridis),
  near: rgb(viridis).reverse(),  // small gaps are brightest
  force: rgb('#ccc2b2 #e3b07f #ea9150 #dd6a3a #c24531 #9c2733 #731336 #470a30'),  // from the cloth's colour
};
const cloth = [204, 194, 178], none = {diverging: [140, 140, 140], sequential: [140, 140, 140], near: cloth, force: cloth};

function colourAt(map, place) {
  const table = maps[map], p = Math.min(Math.max(place, 0), 1) * (table.length - 1);
  const cell = Math.min(Math.floor(p), table.length - 2), share = p - cell;
  return table[cell].map((c, k) => c + (table[cell + 1][k] - c) * share);
}

/// Three bytes per vertex of a block of scalars, on the scale of a field of the document.
export function paint(block, field) {
  const table = new Uint8Array(256 * 3);
  for (let s = 0; s < 255; ++s) {
    const value = block.low + s / 254 * (block.high - block.low);
    table.set(colourAt(field.map, (value - field.low) / (field.high - field.low)), 3 * s);
  }
  table.set(none[field.map], 3 * 255);
  const colours = new Uint8Array(block.steps.length * 3);
  block.steps.forEach((s, i) => colours.set(table.subarray(3 * s, 3 * s + 3), 3 * i));
  return colours;
}

export const gradient = map => 'linear-gradient(90deg, ' + maps[map].map(c => `rgb(${c})`).join(', ') + ')';
