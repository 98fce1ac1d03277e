'use strict';
// What all parts of the page share: elements, numbers, colours.
const gravure = { data: JSON.parse(document.getElementById('report-data').textContent) };

/** Makes an element. Text is always text: nothing from the job is taken for markup. */
gravure.element = (tag, attributes, ...children) => {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value !== null && value !== undefined && value !== false) node.setAttribute(name, value === true ? '' : value);
  }
  for (const child of children) node.append(child);
  return node;
};
gravure.svg = (tag, attributes, ...children) => {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes || {})) node.setAttribute(name, value);
  for (const child of children) node.append(child);
  return node;
};
gravure.at = (id) => document.getElementById(id);

/** "12 345.678": digits that count, groups of three. */
gravure.number = (value, digits = 4) => {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e15) {
    const [mantissa, power] = value.toExponential(Math.max(0, digits - 1)).split('e');
    const raised = [...String(Number(power))].map((c) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]).join('');
    return `${mantissa.replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '').replace('-', '−')} × 10${raised}`;
  }
  const places = Math.max(0, Math.min(9, digits - 1 - Math.floor(Math.log10(size))));
  return gravure.grouped(value.toFixed(places).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, ''));
};
gravure.grouped = (text) => {
  const [whole, rest] = String(text).split('.');
  const grouped = whole.replace(/\B(?=(\d{3})+(?!\d))/g, '\u202f').replace('-', '−');
  return rest === undefined ? grouped : `${grouped}.${rest}`;
};
gravure.percent = (share) => `${gravure.number(100 * share, 3)} %`;
gravure.hertz = (hz) => {
  for (const [unit, size] of [['GHz', 1e9], ['MHz', 1e6], ['kHz', 1e3]]) {
    if (Math.abs(hz) >= size) return `${gravure.number(hz / size, 7)} ${unit}`;
  }
  return `${gravure.number(hz, 7)} Hz`;
};
gravure.duration = (seconds) => {
  const hours = Math.floor(seconds / 3600);
  const minutes = Math.floor((seconds - 3600 * hours) / 60);
  const rest = seconds - 3600 * hours - 60 * minutes;
  if (hours > 0) return `${hours} h ${minutes} min ${rest.toFixed(1)} s`;
  if (minutes > 0) return `${minutes} min ${rest.toFixed(2)} s`;
  return `${gravure.number(seconds, 5)} s`;
};
gravure.turn = () => (gravure.data.job.mode === 'flat' ? 'pass' : 'revolution');
gravure.turns = (count) => `${gravure.grouped(count)} ${gravure.turn()}${count === 1 ? '' : gravure.data.job.mode === 'flat' ? 'es' : 's'}`;

/** Round steps for an axis from `low` to `high`, about `count` of them. */
gravure.ticks = (low, high, count) => {
  const span = high - low;
  if (!(span > 0)) return [low];
  const rough = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const steps = [0.2, 0.5, 1, 2, 5, 10].map((factor) => factor * power);
  const ticksOf = (step) => {
    const ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) ticks.push(i * step);
    return ticks;
  };
  let chosen = steps.findIndex((candidate) => candidate >= rough * 0.999);
  while (chosen > 0 && ticksOf(steps[chosen]).length < 2) --chosen;  // one says where it is, not how large
  return ticksOf(steps[chosen < 0 ? steps.length - 1 : chosen]);
};

/** Depth to colour: paper to a deep blue-green, darker is deeper in every kind of sight. */
gravure.depthColour = (share) => {
  const stops = [[244, 240, 228], [214, 216, 190], [150, 190, 172], [78, 149, 152], [36, 101, 126], [20, 56, 92], [12, 24, 52]];
  const at = Math.min(1, Math.max(0, share)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(at));
  return stops[i].map((low, k) => Math.round(low + (stops[i + 1][k] - low) * (at - i)));
};
gravure.depthGradient = () => {
  const colours = [];
  for (let i = 0; i <= 12; ++i) colours.push(`rgb(${gravure.depthColour(i / 12).join(',')})`);
  return `linear-gradient(90deg, ${colours.join(',')})`;
};
/** 16-bit values in base64 as shares of the most. */
gravure.sixteenBits = (text) => {
  const bytes = atob(text);
  const values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; ++i) values[i] = (bytes.charCodeAt(2 * i) + 256 * bytes.charCodeAt(2 * i + 1)) / 65535;
  return values;
};
/** Two columns of names and values. */
gravure.facts = (rows) => {
  const body = gravure.element('tbody');
  for (const [name, ...value] of rows) {
    body.append(gravure.element('tr', {}, gravure.element('th', { scope: 'row' }, name), gravure.element('td', {}, ...value)));
  }
  return gravure.element('table', { class: 'facts' }, body);
};
/** Calls draw(width) now and whenever the width of the element changes. */
gravure.whenSized = (element, draw) => {
  let width = 0;
  const look = () => {
    const now = Math.round(element.clientWidth);
    if (now > 0 && now !== width) {
      width = now;
      draw(width);
    }
  };
  new ResizeObserver(look).observe(element);
  look();
};
