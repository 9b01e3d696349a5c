'use strict';
// Shows the report that `lsde compare` wrote into this page. All pictures are linear Rec. 709.

const report = JSON.parse(document.getElementById('report').textContent);
const byId = id => document.getElementById(id);
const pixelCount = report.width * report.height;

// ------------------------------------------------------------------------------------------------------------ data blocks

// The bytes of a block: base64 of a zlib stream.
async function blockBytes(id) {
  const text = atob(byId(id).textContent.trim());
  const packed = Uint8Array.from(text, c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const halfValues = Float32Array.from({ length: 65536 }, (_, bits) => {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, mantissa = bits & 1023;
  if (exponent === 31) return mantissa ? NaN : sign * Infinity;
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : 2 ** -14 * mantissa / 1024);
});

// Half floats over a common scale: all high bytes first, then all low bytes.
async function decodePlanes(id, scale = 1) {
  const bytes = await blockBytes(id), count = bytes.length / 2, out = new Float32Array(count);
  for (let i = 0; i < count; ++i) out[i] = scale * halfValues[bytes[i] << 8 | bytes[count + i]];
  return out;
}

// Pictures as planes R, G, B; maps as one plane.
async function decodeLayer({ data, imageScale, referenceScale }) {
  const [image, reference, flip, hdrFlip] = await Promise.all([
    decodePlanes(`${data}-image`, imageScale), decodePlanes(`${data}-reference`, referenceScale),
    decodePlanes(`${data}-flip`), decodePlanes(`${data}-hdrflip`)]);
  return { image, reference, flip, hdrFlip, maps: {} };
}

// ------------------------------------------------------------------------------------------------------------------ colours

// The sRGB curve to 8 bits, by a table fine enough for its steep beginning.
const displayTable = Uint8ClampedArray.from({ length: 16385 }, (_, i) => {
  const x = i / 16384;
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
});
const displayed = linear => displayTable[Math.min(Math.max(linear, 0), 1) * 16384 + 0.5 | 0];

// Colour maps by a few stops, mixed in between. Errors: dark to light, like the map "magma". Differences: black at zero.
const errorStops = [[0, 0, 4], [28, 16, 68], [79, 18, 123], [129, 37, 129], [181, 54, 122], [229, 80, 100], [251, 135, 97],
  [254, 194, 135], [252, 253, 191]];
const differenceStops = [[190, 232, 255], [64, 160, 240], [24, 70, 140], [0, 0, 0], [150, 62, 10], [248, 140, 40],
  [255, 232, 180]];
const colorTable = stops => Array.from({ length: 256 }, (_, i) => {
  const at = i / 255 * (stops.length - 1), low = Math.min(Math.floor(at), stops.length - 2);
  return stops[low].map((v, c) => Math.round(v + (at - low) * (stops[low + 1][c] - v)));
});
const errorColors = colorTable(errorStops), differenceColors = colorTable(differenceStops);
const notFiniteColor = [255, 0, 255];

// -------------------------------------------------------------------------------------------------------------------- views

const meanOver = f => (f(0) + f(1) + f(2)) / 3;
// value(layer, pixel) of each map; a map without a fixed range takes its own from its values.
const maps = {
  difference: {
    label: 'Difference', name: 'I\u2212R, mean of channels: blue darker, orange brighter than the reference', signed: true,
    value: (l, p) => meanOver(c => l.image[c * pixelCount + p] - l.reference[c * pixelCount + p]),
  },
  relmse: {
    label: 'relMSE', name: `(I\u2212R)\u00b2/(R\u00b2+${report.relMseEpsilon}), mean of channels`,
    value: (l, p) => meanOver(c => {
      const i = l.image[c * pixelCount + p], r = l.reference[c * pixelCount + p];
      return (i - r) ** 2 / (r * r + report.relMseEpsilon);
    }),
  },
  smape: {
    label: 'SMAPE', name: `|I\u2212R|/(|I|+|R|+${report.smapeEpsilon}), mean of channels`,
    value: (l, p) => meanOver(c => {
      const i = l.image[c * pixelCount + p], r = l.reference[c * pixelCount + p];
      return Math.abs(i - r) / (Math.abs(i) + Math.abs(r) + report.smapeEpsilon);
    }),
  },
  flip: { label: 'FLIP', name: 'LDR-FLIP', range: 1, value: (l, p) => l.flip[p] },
  hdrflip: { label: 'HDR-FLIP', name: 'largest FLIP over the exposures', range: 1, value: (l, p) => l.hdrFlip[p] },
};
const views = { slider: 'Slider', image: 'Picture', reference: 'Reference' };
for (const id in maps) views[id] = maps[id].label;

const state = { layer: null, data: null, view: 'slider', split: 0.5, zoom: 1, panX: 0, panY: 0, fitted: true,
  probe: { x: report.width >> 1, y: report.height >> 1 } };
const canvas = byId('canvas'), context = canvas.getContext('2d');
// Pictures at one pixel each, redrawn when what they show changes: the picture or a map, and the reference.
const buffers = [0, 1].map(() => Object.assign(document.createElement('canvas'), { width: report.width, height: report.height }));

// write(p, bytes, i) sets the bytes i, i+1, i+2 to the colour of pixel p.
function paint(buffer, write) {
  const target = buffer.getContext('2d'), data = target.createImageData(report.width, report.height), bytes = data.data;
  bytes.fill(255);
  for (let p = 0; p < pixelCount; ++p) write(p, bytes, 4 * p);
  target.putImageData(data, 0, 0);
}

function paintPicture(buffer, picture) {
  const factor = 2 ** +byId('exposure').value;
  paint(buffer, (p, bytes, i) => {
    const r = picture[p], g = picture[pixelCount + p], b = picture[2 * pixelCount + p];
    if (!Number.isFinite(r + g + b)) return bytes.set(notFiniteColor, i);
    bytes[i] = displayed(factor * r);
    bytes[i + 1] = displayed(factor * g);
    bytes[i + 2] = displayed(factor * b);
  });
}

// 1, 2 or 5 times a power of ten, at least x.
function niceAbove(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * ([1, 2, 5].find(m => m * power >= x * 0.999) ?? 10);
}

// Covers 99.5% of the values, so that a few fireflies do not hide the rest.
function rangeOf(values) {
  const sizes = values.filter(Number.isFinite).map(Math.abs).sort();
  const high = sizes[Math.floor(0.995 * (sizes.length - 1))];
  return high > 0 ? niceAbove(high) : 1;
}

// All values of a map, kept with the layer, and the range that its colours span.
function mapValues(id) {
  const map = maps[id];
  return state.data.maps[id] ??= (() => {
    const values = Float32Array.from({ length: pixelCount }, (_, p) => map.value(state.data, p));
    return { values, range: map.range ?? rangeOf(values) };
  })();
}

function paintMap(id) {
  const map = maps[id], { values, range: ownRange } = mapValues(id);
  const range = +(ownRange * 2 ** -byId('gain').value).toPrecision(4), colors = map.signed ? differenceColors : errorColors;
  paint(buffers[0], (p, bytes, i) => {
    const value = values[p] / range;
    if (!Number.isFinite(value)) return bytes.set(notFiniteColor, i);
    bytes.set(colors[Math.min(Math.max(Math.round(255 * (map.signed ? (value + 1) / 2 : value)), 0), 255)], i);
  });
  const bar = byId('map-bar').getContext('2d');
  colors.forEach((c, i) => { bar.fillStyle = `rgb(${c})`; bar.fillRect(i, 0, 1, 1); });
  byId('map-low').textContent = map.signed ? `\u2212${range}` : '0';
  byId('map-high').textContent = String(range);
  byId('map-name').textContent = map.name;
}

// Repaints the buffers for the view, exposure and range at hand.
function repaint() {
  if (!state.data) return;
  const map = maps[state.view];
  if (map) paintMap(state.view);
  else {
    paintPicture(buffers[0], state.view === 'reference' ? state.data.reference : state.data.image);
    if (state.view === 'slider') paintPicture(buffers[1], state.data.reference);
  }
  const stops = +byId('exposure').value;
  byId('exposure-value').textContent = `${stops > 0 ? '+' : ''}${stops.toFixed(1)} stops`;
  byId('exposure-choice').hidden = Boolean(map);
  byId('gain-choice').hidden = byId('map-legend').hidden = !map;
  byId('divider').hidden = byId('right-tag').hidden = state.view !== 'slider';
  byId('left-tag').textContent = state.view === 'slider' ? 'Picture' : views[state.view];
  canvas.setAttribute('aria-label', `${views[state.view]} of ${layerName(state.layer)}`);
  draw();
}

// ------------------------------------------------------------------------------------------------------------ pan and zoom

// In pixels of the screen; the picture's corner is at (panX, panY).
const screenScale = () => window.devicePixelRatio || 1;

function draw() {
  const { zoom, panX, panY } = state, w = report.width * zoom, h = report.height * zoom;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.imageSmoothingEnabled = zoom < 1;
  context.imageSmoothingQuality = 'high';
  context.drawImage(buffers[0], panX, panY, w, h);
  if (state.view === 'slider') {
    const x = state.split * canvas.width;
    context.save();
    context.beginPath();
    context.rect(x, 0, canvas.width - x, canvas.height);
    context.clip();
    context.drawImage(buffers[1], panX, panY, w, h);
    context.restore();
  }
  context.lineWidth = screenScale();
  context.strokeStyle = '#777';
  context.strokeRect(panX - 1, panY - 1, w + 2, h + 2);
  if (zoom >= 4) {
    context.strokeStyle = '#fff';
    context.strokeRect(panX + state.probe.x * zoom, panY + state.probe.y * zoom, zoom, zoom);
  }
  byId('zoom').textContent = `${Math.round(100 * zoom)}%`;
  byId('divider').style.left = `${100 * state.split}%`;
  byId('divider').setAttribute('aria-valuenow', Math.round(100 * state.split));
}

function fit() {
  state.zoom = Math.min(canvas.width / report.width, canvas.height / report.height);
  state.panX = (canvas.width - report.width * state.zoom) / 2;
  state.panY = (canvas.height - report.height * state.zoom) / 2;
  state.fitted = true;
  draw();
}

// Zooms about a point of the canvas, by default its middle.
function zoomTo(zoom, x = canvas.width / 2, y = canvas.height / 2) {
  zoom = Math.min(Math.max(zoom, 1 / 16), 64);
  state.panX = x - (x - state.panX) * zoom / state.zoom;
  state.panY = y - (y - state.panY) * zoom / state.zoom;
  state.zoom = zoom;
  state.fitted = false;
  draw();
}

function resize() {
  const box = canvas.getBoundingClientRect();
  canvas.width = Math.round(box.width * screenScale());
  canvas.height = Math.round(box.height * screenScale());
  if (state.fitted) fit(); else draw();
}

function canvasPoint(event) {
  const box = canvas.getBoundingClientRect();
  return { x: (event.clientX - box.left) * screenScale(), y: (event.clientY - box.top) * screenScale() };
}

// Follows the pointer until it is released: move(event) for each of its movements.
function drag(event, move) {
  event.target.setPointerCapture(event.pointerId);
  event.target.onpointermove = move;
  event.target.onpointerup = event.target.onpointercancel = () => { event.target.onpointermove = null; };
}

canvas.addEventListener('pointerdown', event => {
  let last = canvasPoint(event);
  drag(event, moved => {
    const now = canvasPoint(moved);
    state.panX += now.x - last.x;
    state.panY += now.y - last.y;
    state.fitted = false;
    last = now;
    draw();
  });
});
canvas.addEventListener('dblclick', fit);
canvas.addEventListener('wheel', event => {
  event.preventDefault();
  const { x, y } = canvasPoint(event);
  zoomTo(state.zoom * 2 ** (-event.deltaY / (event.deltaMode ? 6 : 240)), x, y);
}, { passive: false });
canvas.addEventListener('pointermove', event => {
  if (event.buttons) return;  // the picture moves with the pointer
  const { x, y } = canvasPoint(event);
  probe(Math.floor((x - state.panX) / state.zoom), Math.floor((y - state.panY) / state.zoom));
});
canvas.addEventListener('keydown', event => {
  const step = event.shiftKey ? 10 : 1, at = state.probe;
  const keys = {
    ArrowLeft: () => probe(at.x - step, at.y), ArrowRight: () => probe(at.x + step, at.y),
    ArrowUp: () => probe(at.x, at.y - step), ArrowDown: () => probe(at.x, at.y + step),
    '+': () => zoomTo(state.zoom * 1.5), '=': () => zoomTo(state.zoom * 1.5), '-': () => zoomTo(state.zoom / 1.5),
    0: fit, 1: () => zoomTo(1),
  };
  if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
  event.preventDefault();
  keys[event.key]();
});

function setSplit(split) {
  state.split = Math.min(Math.max(split, 0), 1);
  draw();
}
byId('divider').addEventListener('pointerdown', event => drag(event, moved => setSplit(canvasPoint(moved).x / canvas.width)));
byId('divider').addEventListener('keydown', event => {
  const to = {
    ArrowLeft: state.split - 0.01, ArrowDown: state.split - 0.01, ArrowRight: state.split + 0.01, ArrowUp: state.split + 0.01,
    PageDown: state.split - 0.1, PageUp: state.split + 0.1, Home: 0, End: 1,
  }[event.key];
  if (to === undefined) return;
  event.preventDefault();
  setSplit(to);
});

// ------------------------------------------------------------------------------------------------------------------ figures

// Four significant digits; what JSON cannot hold is null.
function show(value) {
  if (value === null || Number.isNaN(value)) return 'n/a';
  if (!Number.isFinite(value)) return value > 0 ? '\u221e' : '\u2212\u221e';
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(3) : size === 0 ? '0' : value.toPrecision(4);
  return text.replace('-', '\u2212').replace('e-', 'e\u2212').replace('e+', 'e');
}
const percent = ratio => ratio === null ? 'n/a' : `${ratio >= 1 ? '+' : '\u2212'}${(100 * Math.abs(ratio - 1)).toFixed(3)}%`;
// An infinite PSNR, that of equal pictures, is null in JSON.
const showMetric = (metric, layer) =>
  metric.id === 'psnr' && layer.metrics.psnr === null ? '\u221e' : show(layer.metrics[metric.id]);
const layerName = layer => layer.layer || 'the picture';

function element(tag, properties, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

// A row of a <dl>, as a group.
const entry = (term, value, title = '') => element('div', { title }, element('dt', {}, term), element('dd', {}, value));

function showSummary(layer) {
  byId('summary').replaceChildren(
    ...report.metrics.map(m => entry(m.name, showMetric(m, layer) + (m.id === 'psnr' ? ' dB' : ''), m.formula)),
    entry('mean I/R \u2212 1', percent(layer.mean.ratio), 'mean of the picture over the mean of the reference, minus 1'));
}

function showFigures() {
  const head = ['layer', ...report.metrics.map(m => m.name), 'mean I', 'mean R', 'I/R', 'not finite'];
  const average = v => (v[0] + v[1] + v[2]) / 3;
  const rows = report.layers.map(layer => {
    const bad = layer.notFinite.image + layer.notFinite.reference;
    const row = element('tr', {}, element('th', { scope: 'row' }, layerName(layer)),
      ...report.metrics.map(m => element('td', {}, showMetric(m, layer))),
      element('td', {}, show(average(layer.mean.image))), element('td', {}, show(average(layer.mean.reference))),
      element('td', {}, layer.mean.ratio === null ? 'n/a' : layer.mean.ratio.toFixed(5)),
      element('td', { className: bad ? 'bad' : '' }, String(bad)));
    if (layer === state.layer) row.setAttribute('aria-current', 'true');
    return row;
  });
  byId('figures').replaceChildren(
    element('thead', {}, element('tr', {}, ...head.map(text => element('th', { scope: 'col' }, text)))),
    element('tbody', {}, ...rows));
}

function showFormulas() {
  const exposures = state.layer.hdrFlipExposures;
  const notes = {
    hdrflip: `; for this layer ${exposures.count} exposures from ${show(exposures.start)} to ${show(exposures.stop)} stops`,
  };
  byId('formulas').replaceChildren(...report.metrics.flatMap(m =>
    [element('dt', {}, m.name), element('dd', {}, m.formula + (notes[m.id] ?? '') + (m.largerIsBetter ? '; larger is better' : ''))]));
}

// Both pictures and all errors at a pixel, to the eleven bits of a half float.
function probe(x, y) {
  if (!state.data || x < 0 || y < 0 || x >= report.width || y >= report.height) return;
  state.probe = { x, y };
  const p = y * report.width + x, rgb = picture => [0, 1, 2].map(c => picture[c * pixelCount + p]);
  const image = rgb(state.data.image), reference = rgb(state.data.reference), factor = 2 ** +byId('exposure').value;
  const row = (label, values, swatch) => element('tr', {},
    element('th', { scope: 'row' }, ...(swatch ? [swatch] : []), label), ...values.map(v => element('td', {}, show(v))));
  const swatch = values => {
    const node = element('span', { className: 'swatch' });
    node.style.background = `rgb(${values.map(v => displayed(factor * v))})`;
    return node;
  };
  byId('probe-at').textContent = `x ${x + report.x0}, y ${y + report.y0}`;
  byId('probe-rows').replaceChildren(row('Picture', image, swatch(image)), row('Reference', reference, swatch(reference)),
    row('Difference', image.map((v, c) => v - reference[c])), row('Ratio', image.map((v, c) => v / reference[c])));
  byId('probe-errors').replaceChildren(...Object.values(maps).filter(m => !m.signed).flatMap(m =>
    [element('dt', {}, m.label), element('dd', {}, show(m.value(state.data, p)))]));
  draw();
}

// -------------------------------------------------------------------------------------------------------------------- start

function warn(text) {
  byId('warning').textContent = text;
  byId('warning').hidden = !text;
}

async function showLayer(layer) {
  state.layer = layer;
  state.data = null;
  showSummary(layer);
  showFigures();
  showFormulas();
  const { image, reference } = layer.notFinite;
  warn(image + reference ? `Not finite: ${image} pixels of the picture, ${reference} of the reference. `
    + 'They count as black in the figures and are magenta here.' : '');
  try {
    state.data = await decodeLayer(layer);
  } catch (error) {
    warn(`The pictures cannot be unpacked: ${error.message}. A browser of 2023 or later is needed.`);
    return;
  }
  repaint();
  probe(state.probe.x, state.probe.y);
}

function setUpControls() {
  for (const id in views) {
    const input = element('input', { type: 'radio', name: 'view', value: id, checked: id === state.view });
    input.addEventListener('change', () => { state.view = id; byId('gain').value = 0; repaint(); });
    byId('views').append(element('label', {}, input, views[id]));
  }
  const shown = report.layers.filter(l => l.data);
  byId('layer').append(...shown.map(l => element('option', { value: l.data }, layerName(l))));
  byId('layer').addEventListener('change', event => showLayer(shown.find(l => l.data === event.target.value)));
  byId('layer-choice').hidden = shown.length < 2;
  for (const id of ['exposure', 'gain']) {
    byId(id).addEventListener('input', repaint);
    byId(`${id}-reset`).addEventListener('click', () => { byId(id).value = 0; repaint(); });
  }
  byId('exposure-auto').addEventListener('click', () => {
    const values = state.data.reference.filter(v => v > 0 && Number.isFinite(v)).sort();
    if (values.length) byId('exposure').value = -Math.log2(values[Math.floor(0.99 * (values.length - 1))]);
    repaint();
  });
  byId('zoom-in').addEventListener('click', () => zoomTo(state.zoom * 1.5));
  byId('zoom-out').addEventListener('click', () => zoomTo(state.zoom / 1.5));
  byId('fit').addEventListener('click', fit);
  byId('actual').addEventListener('click', () => zoomTo(1));
}

function start() {
  document.title = `${report.image} against ${report.reference} \u2013 lsde compare`;
  byId('image-name').textContent = report.image;
  byId('reference-name').textContent = report.reference;
  const corner = report.x0 || report.y0 ? ` from x ${report.x0}, y ${report.y0}` : '';
  byId('size').textContent = `${report.width} \u00d7 ${report.height} pixels${corner}`;
  const leftOut = report.layers.filter(l => !l.data).map(layerName);
  byId('left-out').textContent = `To keep this page small, the pictures of these layers were left out: ${leftOut.join(', ')}.`
    + ' Write a report of one with --layer.';
  byId('left-out').hidden = leftOut.length === 0;
  setUpControls();
  new ResizeObserver(resize).observe(canvas);
  showLayer(report.layers[0]);
}

start();
