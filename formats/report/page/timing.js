'use strict';
// One line against ticks: mirrors, gate, A and B; zoomable to single ticks.

/** Of the line of `data`, which is called `name` on the page; `pinNames`: the outputs that are drawn below the gate. */
gravure.timingView = ({ line, clock, job } = gravure.data, name = 'line', pinNames = ['A', 'B']) => {
  const { svg, element, number, grouped } = gravure;
  const whole = clock.ticks_per_line;
  const perSlot = clock.ticks_per_slot;
  const what = name === 'line' ? `Line ${grouped(line.line)} of ${gravure.turn()} ${grouped(line.revolution)} runs ${line.reverse ? 'right to left' : 'left to right'} and fires` : `In ${name} ${grouped(line.line)}, the first that fires, there ${line.fired === 1 ? 'is' : 'are'}`;
  gravure.at('timing-lead').textContent = `${what} ${grouped(line.fired)} ${line.fired === 1 ? 'pulse' : 'pulses'} in ${grouped(clock.slots_per_line)} slots: ${grouped(whole)} ticks, ${number((1e6 * whole) / clock.fpga_hz, 6)} µs.`;
  const edges = [];  // ticks
  let tick = 0;
  for (const step of line.edge_steps) edges.push((tick += step));
  const gray = [0, 1, 3, 2];  // (A, B) as 2 A + B, in order
  const start = gray.indexOf(line.ab_at_start);
  const pins = (edge) => gray[(((line.backward ? start - edge : start + edge) % 4) + 4) % 4];
  const runs = [];
  for (let i = 0; i < line.gate.length; i += 2) runs.push([line.gate[i], line.gate[i] + line.gate[i + 1]]);

  const place = gravure.at('timing-view');
  const buttons = element('div', { class: 'buttons', role: 'group', 'aria-label': 'Zoom' });
  const holder = element('div', { tabindex: 0, role: 'application', 'aria-label': `Timing of one ${name}; plus and minus zoom, arrow keys move, Home shows the whole ${name}` });
  const readout = element('p', { class: 'readout' }, '');
  const controls = element('div', { class: 'controls' }, buttons, element('span', { class: 'small' }, 'Drag to move; Ctrl and wheel, two fingers, or + and − to zoom.'));
  place.append(controls, holder, readout);

  const view = { from: 0, to: whole };
  const clamp = () => {
    const span = Math.min(whole, Math.max(8, view.to - view.from));
    view.from = Math.min(whole - span, Math.max(0, view.from));
    view.to = view.from + span;
  };
  const zoom = (factor, about = (view.from + view.to) / 2) => {
    const span = Math.min(whole, Math.max(8, (view.to - view.from) * factor));
    const share = (about - view.from) / (view.to - view.from);
    view.from = about - share * span;
    view.to = view.from + span;
    clamp();
    draw();
  };
  const move = (share) => {
    const by = share * (view.to - view.from);
    view.from += by;
    view.to += by;
    clamp();
    draw();
  };
  const button = (text, label, act) => {
    const node = element('button', { type: 'button', 'aria-label': label, title: label }, text);
    node.addEventListener('click', act);
    buttons.append(node);
  };
  button('−', 'Zoom out', () => zoom(2));
  button('+', 'Zoom in', () => zoom(0.5));
  button('←', 'Earlier', () => move(-0.25));
  button('→', 'Later', () => move(0.25));
  button(`Whole ${name.split(' ').pop()}`, `Show the whole ${name}`, () => { view.from = 0; view.to = whole; draw(); });
  button('First pulses', 'Show the first pulses', () => {
    const first = runs.length ? runs[0][0] : line.first_slot;
    view.from = (first - 2) * perSlot;
    view.to = (first + 10) * perSlot;
    clamp();
    draw();
  });

  /** First index whose value is above `value`. */
  const above = (values, value) => {
    let low = 0;
    let high = values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[middle] > value) high = middle;
      else low = middle + 1;
    }
    return low;
  };
  const mirrorAt = (index, at) => {
    const samples = line.mirrors;
    if (!samples.length) return null;
    const slot = at / perSlot;
    const next = Math.max(1, Math.min(samples.length - 1, samples.findIndex((sample) => sample[0] > slot)));
    const [a, b] = [samples[next - 1], samples[next] || samples[next - 1]];
    const share = b[0] === a[0] ? 0 : Math.min(1, Math.max(0, (slot - a[0]) / (b[0] - a[0])));
    return a[index] + share * (b[index] - a[index]);
  };
  let frameWidth = 0;
  const left = 74;
  const lanes = [];
  const draw = () => {
    const width = frameWidth;
    if (!width) return;
    const right = width - 12;
    const x = (at) => left + ((at - view.from) / (view.to - view.from)) * (right - left);
    const analogue = line.mirrors.length ? 92 : 0;
    lanes.length = 0;
    let y = 8;
    if (analogue) {
      lanes.push(['U', y, analogue]);
      y += analogue + 16;
      lanes.push(['V', y, analogue]);
      y += analogue + 16;
    }
    for (const lane of ['gate', ...pinNames]) {
      lanes.push([lane, y, 30]);
      y += 44;
    }
    const height = y + 34;
    const chart = svg('svg', { class: 'chart', viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `Timing from tick ${Math.round(view.from)} to ${Math.round(view.to)}` });
    const clip = svg('clipPath', { id: 'timing-clip' }, svg('rect', { x: left, y: 0, width: right - left, height }));
    chart.append(svg('defs', {}, clip));
    const inside = svg('g', { 'clip-path': 'url(#timing-clip)' });
    const marks = gravure.ticks(view.from, view.to, Math.max(2, width / 130));
    for (const mark of marks) {
      chart.append(svg('line', { x1: x(mark), x2: x(mark), y1: 4, y2: y - 6, stroke: 'var(--line)' }));
      chart.append(svg('text', { x: x(mark), y: y + 10, 'text-anchor': 'middle' }, grouped(Math.round(mark))));
    }
    chart.append(svg('text', { x: (left + right) / 2, y: y + 28, 'text-anchor': 'middle' }, `FPGA ticks from the begin of the ${name}`));
    chart.append(inside);
    const window = [line.first_slot * perSlot, (line.first_slot + job.pixels_per_line) * perSlot];
    inside.append(svg('rect', { x: x(window[0]), width: Math.max(0, x(window[1]) - x(window[0])), y: 2, height: y - 8, fill: 'var(--accent)', opacity: 0.06 }));
    for (const [lane, top, size] of lanes) {
      chart.append(svg('text', { class: 'strong', x: 2, y: top + size / 2 + 4, style: 'font-weight: 600' }, lane));
      if (lane === 'U' || lane === 'V') drawMirror(chart, inside, lane === 'U' ? 1 : 2, top, size, x, right);
      else if (lane === 'gate') drawGate(inside, top, size, x, right - left);
      else drawPin(inside, lane === 'A' ? 1 : 0, top, size, x, right - left);
    }
    chart.addEventListener('pointermove', (event) => say(event, chart, right));
    holder.replaceChildren(chart);
  };
  const drawMirror = (chart, inside, index, top, size, x, right) => {
    const values = line.mirrors.map((sample) => sample[index]);
    let low = Math.min(...values);
    let high = Math.max(...values);
    if (high - low < 1e-9) { low -= 0.5; high += 0.5; }
    const micro = Math.max(Math.abs(low), Math.abs(high)) < 0.5;
    const y = (value) => top + size - ((value - low) / (high - low)) * size;
    const digits = Math.max(3, 2 + Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low))));
    for (const value of gravure.ticks(low, high, 3)) {
      chart.append(svg('line', { x1: left, x2: right, y1: y(value), y2: y(value), stroke: 'var(--line)', 'stroke-dasharray': '2 3' }));
      chart.append(svg('text', { x: left - 6, y: y(value) + 4, 'text-anchor': 'end' }, number(micro ? 1000 * value : value, digits)));
    }
    chart.append(svg('text', { x: 2, y: top + size / 2 + 18 }, micro ? 'µm' : 'mm'));
    const points = line.mirrors.map((sample) => [x(sample[0] * perSlot), y(sample[index])]);
    inside.append(svg('path', { class: 'mirror', d: gravure.path(points), fill: 'none', stroke: index === 1 ? 'var(--accent)' : 'var(--second)', 'stroke-width': 2, 'stroke-linejoin': 'round' }));
  };
  const drawGate = (inside, top, size, x, width) => {
    inside.append(svg('line', { x1: x(view.from), x2: x(view.to), y1: top + size, y2: top + size, stroke: 'var(--quiet)' }));
    const slotWidth = (width * perSlot) / (view.to - view.from);
    const seen = runs.filter(([from, to]) => to * perSlot > view.from && from * perSlot < view.to);
    if (seen.length > 2000) {  // shares of pixel columns
      const columns = new Float64Array(Math.ceil(width) + 1);
      for (const [from, to] of seen) {
        let a = x(from * perSlot) - left;
        const b = Math.min(width, x(to * perSlot) - left);
        for (a = Math.max(0, a); a < b; a = Math.floor(a) + 1) columns[Math.floor(a)] += Math.min(Math.floor(a) + 1, b) - a;
      }
      columns.forEach((share, i) => {
        if (share > 0) inside.append(svg('rect', { x: left + i, width: 1, y: top + size * (1 - share), height: size * share, fill: 'var(--ink)' }));
      });
      return;
    }
    for (const [from, to] of seen) {
      const a = Math.max(x(view.from) - 2, x(from * perSlot));
      const b = Math.min(x(view.to) + 2, x(to * perSlot));
      inside.append(svg('rect', { class: 'gate', x: a, width: Math.max(0.7, b - a), y: top, height: size, fill: 'var(--ink)', opacity: slotWidth > 7 ? 0.25 : 0.75 }));
      if (slotWidth <= 7) continue;
      for (let slot = Math.max(from, Math.floor(view.from / perSlot)); slot < Math.min(to, view.to / perSlot); ++slot) {
        inside.append(svg('line', { class: 'pulse', x1: x(slot * perSlot), x2: x(slot * perSlot), y1: top - 4, y2: top + size, stroke: 'var(--bad)', 'stroke-width': 2 }));
      }
    }
  };
  const drawPin = (inside, bit, top, size, x, width) => {
    const first = above(edges, view.from);
    const last = above(edges, view.to);
    const level = (edge) => ((pins(edge) >> bit) & 1 ? top : top + size);
    if (last - first > width) {
      inside.append(svg('rect', { x: left, width, y: top, height: size, fill: 'var(--accent)', opacity: 0.3 }));
      inside.append(svg('text', { class: 'strong', x: left + width / 2, y: top + size / 2 + 4, 'text-anchor': 'middle' }, `${grouped(last - first)} edges of A and B: zoom in`));
      return;
    }
    const points = [[x(view.from), level(first)]];
    for (let edge = first; edge < last; ++edge) points.push([x(edges[edge]), level(edge)], [x(edges[edge]), level(edge + 1)]);
    points.push([x(view.to), level(last)]);
    inside.append(svg('path', { class: 'pin', d: gravure.path(points), fill: 'none', stroke: 'var(--accent)', 'stroke-width': 1.6 }));
  };
  const tickAt = (event, chart, right) => {
    const box = chart.getBoundingClientRect();
    const at = ((event.clientX - box.left) / box.width) * frameWidth;
    return view.from + ((at - left) / (right - left)) * (view.to - view.from);
  };
  const say = (event, chart, right) => {
    const at = Math.floor(tickAt(event, chart, right));
    if (at < 0 || at >= whole) return;
    const slot = Math.floor(at / perSlot);
    const fires = runs.some(([from, to]) => slot >= from && slot < to);
    const ab = pins(above(edges, at));
    const parts = [`tick ${grouped(at)}`, `slot ${grouped(slot)}`, `${number((1e6 * at) / clock.fpga_hz, 6)} µs`, `gate ${fires ? 'open' : 'closed'}`];
    if (pinNames.length) parts.push(`A ${ab >> 1}`, `B ${ab & 1}`);
    if (line.mirrors.length) parts.push(`U ${number(mirrorAt(1, at), 6)} mm`, `V ${number(1000 * mirrorAt(2, at), 5)} µm`);
    readout.textContent = parts.join('  ·  ');
  };
  holder.addEventListener('wheel', (event) => {
    if (!event.ctrlKey && document.activeElement !== holder) return;
    event.preventDefault();
    zoom(event.deltaY > 0 ? 1.25 : 0.8, tickAt(event, holder.firstChild, frameWidth - 12));
  }, { passive: false });
  holder.addEventListener('keydown', (event) => {
    const act = { '+': () => zoom(0.5), '=': () => zoom(0.5), '-': () => zoom(2), ArrowLeft: () => move(-0.2), ArrowRight: () => move(0.2), Home: () => { view.from = 0; view.to = whole; draw(); } }[event.key];
    if (act) {
      event.preventDefault();
      act();
    }
  });
  gravure.whenDragged(holder, {
    move: (dx) => move(-dx / (frameWidth - left - 12)),
    pinch: (factor, x) => zoom(1 / factor, view.from + ((x - left) / (frameWidth - left - 12)) * (view.to - view.from)),
  });
  gravure.whenSized(holder, (width) => { frameWidth = width; draw(); });
  const say2 = [];
  if (line.no_mirrors) say2.push(`U and V are not shown: ${line.no_mirrors}.`);
  if (line.gate_cut || line.edges_cut) say2.push(`This ${name} has more changes than the page holds; the rest is left out.`);
  for (const text of say2) place.append(element('p', { class: 'small' }, text));
  gravure.timing = { view, zoom, draw };
};

/** Drags with one pointer, pinches with two; coordinates in the element's own pixels. */
gravure.whenDragged = (node, { move, pinch }) => {
  const pointers = new Map();
  node.addEventListener('pointerdown', (event) => {
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  node.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    if (!node.hasPointerCapture(event.pointerId)) node.setPointerCapture(event.pointerId);
    const others = [...pointers.entries()].filter(([id]) => id !== event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (!others.length) {
      move(event.clientX - before[0], event.clientY - before[1]);
    } else {
      const [x, y] = others[0][1];
      const was = Math.hypot(before[0] - x, before[1] - y);
      const now = Math.hypot(event.clientX - x, event.clientY - y);
      const box = node.getBoundingClientRect();
      if (was > 0 && now > 0) pinch(now / was, (event.clientX + x) / 2 - box.left, (event.clientY + y) / 2 - box.top);
    }
  });
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) {
    node.addEventListener(end, (event) => pointers.delete(event.pointerId));
  }
};
