'use strict';
// Seam error, error budget, clock tree, fired shares.

/** A frame with axes: gives the group to draw in, and how values become places. */
gravure.frame = (width, height, x, y, label) => {
  const margin = { left: 58, right: 14, top: 12, bottom: 40 };
  const { svg } = gravure;
  const right = width - margin.right;
  const bottom = height - margin.bottom;
  const placeX = (value) => margin.left + ((value - x.low) / (x.high - x.low || 1)) * (right - margin.left);
  const placeY = (value) => bottom - ((value - y.low) / (y.high - y.low || 1)) * (bottom - margin.top);
  const chart = svg('svg', { class: 'chart', viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': label });
  for (const tick of gravure.ticks(y.low, y.high, Math.max(2, height / 60))) {
    const at = placeY(tick);
    chart.append(svg('line', { x1: margin.left, x2: right, y1: at, y2: at, stroke: 'var(--line)' }));
    chart.append(svg('text', { x: margin.left - 8, y: at + 4, 'text-anchor': 'end' }, y.text ? y.text(tick) : gravure.number(tick, 3)));
  }
  for (const tick of gravure.ticks(x.low, x.high, Math.max(2, width / 110))) {
    if (x.whole && tick !== Math.round(tick)) continue;
    chart.append(svg('text', { x: placeX(tick), y: bottom + 17, 'text-anchor': 'middle' }, x.text ? x.text(tick) : gravure.number(tick, 4)));
  }
  chart.append(svg('text', { x: (margin.left + right) / 2, y: height - 4, 'text-anchor': 'middle' }, x.name));
  chart.append(svg('text', { x: -(margin.top + bottom) / 2, y: 12, 'text-anchor': 'middle', transform: 'rotate(-90)' }, y.name));
  return { chart, placeX, placeY, left: margin.left, right, top: margin.top, bottom };
};

gravure.path = (points) => points.map(([x, y], i) => `${i ? 'L' : 'M'}${x.toFixed(2)} ${y.toFixed(2)}`).join('');

gravure.seamChart = () => {
  const { seam, job } = gravure.data;
  const place = gravure.at('seam-chart');
  const share = seam.limit_um > 0 ? seam.max_um / seam.limit_um : 0;
  gravure.at('seam-lead').textContent = `How far the axis is from where the next line is marked, when a ${gravure.turn()} has ended. Worst ${gravure.number(seam.max_um, 6)} µm (${gravure.turn()} ${gravure.grouped(seam.worst_revolution)}, line ${gravure.grouped(seam.worst_line)}): ${seam.max_um === 0 ? 'exactly none' : gravure.percent(share)} of the limit of ${gravure.number(seam.limit_um)} µm.`;
  const points = [[0, 0], ...seam.points.map(([revolution, um]) => [revolution + 1, um])];
  const last = points[points.length - 1][0];
  const reach = 1.12 * Math.max(seam.limit_um, ...points.map(([, um]) => Math.abs(um)));
  const readout = gravure.element('p', { class: 'readout', 'aria-live': 'polite' });
  const holder = gravure.element('div', { tabindex: 0, 'aria-label': 'Seam error; arrow keys read the points' });
  place.append(holder, readout);
  let chosen = points.length - 1;
  let frame = null;
  let marker = null;
  const choose = (index) => {
    chosen = Math.max(1, Math.min(points.length - 1, index));
    const [at, um] = points[chosen];
    marker.setAttribute('cx', frame.placeX(at));
    marker.setAttribute('cy', frame.placeY(um));
    readout.textContent = `After ${gravure.turn()} ${gravure.grouped(at - 1)}: ${gravure.number(um, 6)} µm; published bound ${gravure.number(seam.bound_um_per_revolution * at, 4)} µm; limit ${gravure.number(seam.limit_um)} µm`;
  };
  const draw = (width) => {
    const { svg } = gravure;
    frame = gravure.frame(width, Math.max(240, Math.min(320, width * 0.6)), { low: 0, high: Math.max(1, last), name: `${gravure.turn()}${job.mode === 'flat' ? 'es' : 's'} done`, whole: true, text: (tick) => gravure.grouped(tick) }, { low: -reach, high: reach, name: 'seam error, µm' }, `Seam error against ${gravure.turn()}: worst ${seam.max_um} µm, limit ${seam.limit_um} µm`);
    const { chart, placeX, placeY } = frame;
    const limitTop = placeY(seam.limit_um);
    chart.append(svg('rect', { x: frame.left, width: frame.right - frame.left, y: limitTop, height: placeY(-seam.limit_um) - limitTop, fill: 'var(--good)', opacity: 0.08 }));
    for (const sign of [1, -1]) {
      const at = placeY(sign * seam.limit_um);
      chart.append(svg('line', { class: 'limit', x1: frame.left, x2: frame.right, y1: at, y2: at, stroke: 'var(--bad)', 'stroke-width': 1.5 }));
      const end = Math.min(last, seam.bound_um_per_revolution > 0 ? reach / seam.bound_um_per_revolution : last);
      chart.append(svg('path', { class: 'bound', d: gravure.path([[placeX(0), placeY(0)], [placeX(end), placeY(sign * seam.bound_um_per_revolution * end)]]), stroke: 'var(--second)', 'stroke-dasharray': '5 4', fill: 'none', 'stroke-width': 1.5 }));
    }
    chart.append(svg('text', { x: frame.right - 4, y: limitTop - 5, 'text-anchor': 'end', style: 'fill: var(--bad)' }, `limit ${gravure.number(seam.limit_um)} µm`));
    chart.append(svg('text', { x: frame.left + 8, y: placeY(-seam.limit_um) - 8, style: 'fill: var(--second)' }, width < 420 ? '- - published bound' : `- - published bound, ${gravure.number(seam.bound_um_per_revolution, 3)} µm a ${gravure.turn()}`));
    chart.append(svg('path', { class: 'seam', d: gravure.path(points.map(([at, um]) => [placeX(at), placeY(um)])), stroke: 'var(--accent)', fill: 'none', 'stroke-width': 2.5, 'stroke-linejoin': 'round' }));
    if (points.length < 30) for (const [at, um] of points.slice(1)) chart.append(svg('circle', { cx: placeX(at), cy: placeY(um), r: 3, fill: 'var(--accent)' }));
    marker = svg('circle', { r: 5, fill: 'var(--paper)', stroke: 'var(--accent)', 'stroke-width': 2 });
    chart.append(marker);
    chart.addEventListener('pointermove', (event) => {
      const box = chart.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * width;
      let best = 1;
      points.forEach(([at], i) => { if (i && Math.abs(placeX(at) - x) < Math.abs(placeX(points[best][0]) - x)) best = i; });
      choose(best);
    });
    holder.replaceChildren(chart);
    choose(chosen);
  };
  holder.addEventListener('keydown', (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1, PageDown: 20, PageUp: -20 }[event.key];
    if (step) {
      event.preventDefault();
      choose(chosen + step);
    }
  });
  gravure.whenSized(holder, draw);
  const rows = [['Largest of all lines', `${gravure.number(seam.max_um, 6)} µm`], ['After the last line', `${gravure.number(seam.end_um, 6)} µm`]];
  if (seam.measured_end_um !== null) rows.push(['The same, as the device counts edges', `${gravure.number(seam.measured_end_um, 6)} µm`]);
  rows.push(['One A-B edge', `${gravure.number(seam.ab_step_um, 5)} µm on the surface`], ['Line starts, edges against ideal turning', `at most ${gravure.number(seam.axis_error_max_um, 5)} µm`]);
  if (seam.carriage) rows.push(['Carriage, accumulated', `${gravure.number(seam.carriage.end_um, 6)} µm`], ['Carriage, line starts', `at most ${gravure.number(seam.carriage.error_max_um, 5)} µm; one edge ${gravure.number(seam.carriage.ab_step_um, 5)} µm`]);
  gravure.at('seam-table').append(gravure.facts(rows));
};

gravure.budgetBars = () => {
  const { error } = gravure.data;
  const lead = gravure.at('budget-lead');
  if (!error) {
    lead.textContent = 'This verification made no error budget.';
    return;
  }
  lead.textContent = `No pulse lands more than ${gravure.number(error.max_um, 5)} µm from its target${error.limit_um === null ? '; the job sets no limit (limits.landing_um)' : `; limit ${gravure.number(error.limit_um)} µm`}. Each bar: the bound with that cause alone.`;
  const most = Math.max(error.limit_um || 0, error.max_um, 1e-12);
  const bars = gravure.element('div', { class: 'bars', role: 'list' });
  const add = (name, um, text, kind) => {
    const width = um === null ? 0 : Math.min(100, (100 * um) / most);
    const fill = gravure.element('div', { class: `fill ${kind}` });
    fill.style.width = `${width}%`;
    const track = gravure.element('div', { class: 'track' });
    if (um) track.append(fill);
    const off = kind === 'off' ? 'off' : '';
    bars.append(gravure.element('div', { role: 'listitem', class: off }, name), track, gravure.element('div', { class: `value ${off}` }, text));
  };
  const names = { drift: 'drift', ab_step: 'A-B step', galvo_resolution: 'galvo resolution', microvectors: 'microvectors', cross_scan: 'cross-scan', lag: 'lag', defocus: 'defocus', servo: 'servo', run_out: 'run-out', thermal: 'thermal' };
  for (const term of error.terms) {
    if (!term.on) add(names[term.name] || term.name, null, 'off', 'off');
    else if (term.um === null) add(names[term.name] || term.name, null, 'unknown', 'off');
    else add(names[term.name] || term.name, term.name === 'defocus' ? null : term.um, `${gravure.number(term.um, 3)} µm${term.name === 'defocus' ? ' *' : ''}`, '');
  }
  add('all together', error.max_um, `${gravure.number(error.max_um, 3)} µm`, 'other');
  const place = gravure.at('budget-bars');
  place.append(bars);
  const say = [];
  if (error.simulated_pulses > 0) say.push(`${gravure.grouped(error.simulated_pulses)} fired pulses simulated: rms ${gravure.number(error.rms_um, 4)} µm, worst ${gravure.number(error.simulated_max_um, 4)} µm at ${gravure.turn()} ${error.worst[0]}, line ${error.worst[1]}, slot ${error.worst[2]}.`);
  if (error.defocus_um !== null) say.push(`* Distance of the surface from focus, at most ${gravure.number(error.defocus_um, 4)} µm; it moves no pulse.`);
  say.push(...error.notes);
  for (const text of say) place.append(gravure.element('p', { class: 'small' }, text));
};

/** A branch of a clock tree: each node with the step that leads to it. */
gravure.branch = (name, nodes) => {
  const { element } = gravure;
  const list = element('ol', { class: 'tree', 'aria-label': name });
  for (const { title, lines, step, hot } of nodes) {
    const item = element('li');
    if (step) item.append(element('div', { class: 'step' }, step));
    item.append(element('div', { class: hot ? 'node hot' : 'node' }, element('b', {}, title), ...lines.map((line) => element('span', {}, line))));
    list.append(item);
  }
  return [element('h3', { class: 'tree-name' }, name), list];
};

gravure.clockTree = () => {
  const { clock, job } = gravure.data;
  const { branch, grouped, hertz } = gravure;
  const seed = { title: 'Seed laser', lines: [hertz(clock.seed_hz)] };
  const fpga = { title: 'FPGA clock', lines: [hertz(clock.fpga_hz)], step: `× j = ${clock.multiplier}` };
  const place = gravure.at('clock-tree');
  place.append(...branch('Light and lines', [seed, fpga,
    { title: 'Pulse slot', lines: [`${grouped(clock.ticks_per_slot)} ticks`, `${hertz(clock.pulse_hz.value)} of pulses`], step: `÷ j k = ${clock.multiplier} × ${clock.pulse_divider}` },
    { title: 'Line', lines: [`${grouped(clock.ticks_per_line)} ticks`, `${gravure.number(clock.line_hz.value, 7)} lines/s`], step: `÷ ${grouped(clock.slots_per_line)} slots` },
    { title: job.mode === 'flat' ? 'Pass' : 'Revolution', lines: [`${grouped(clock.ticks_per_revolution)} ticks`, job.mode === 'flat' ? `${gravure.number(job.surface_mm_s, 6)} mm/s` : `${gravure.number(job.rpm, 6)} rpm`], step: `÷ ${grouped(clock.lines_per_revolution)} lines`, hot: true }]));
  const drive = (name, counter, last) => {
    const nodes = [{ title: fpga.title, lines: fpga.lines },
      { title: 'Counter', lines: [`${counter.bits} bits`, `adds ${grouped(counter.increment)}`], step: `every m = ${grouped(counter.prescaler)}` }];
    if (counter.fraction_num !== '0') nodes[1].lines.push(`+ ${grouped(counter.fraction_num)} / ${grouped(counter.fraction_den)}`);
    nodes.push({ title: 'A and B', lines: [hertz(counter.output_hz.value), `wanted ${hertz(counter.wanted_hz.value)}`], step: 'two top bits' });
    nodes.push(last(counter));
    return branch(name, nodes);
  };
  const drift = (counter) => (counter.exact ? 'drift 0, for ever' : `drift ${gravure.number(counter.drift_um_per_revolution.value, 4)} µm a ${gravure.turn()}`);
  place.append(...drive(job.mode === 'flat' ? 'Stage' : 'Rotary axis', clock.counter, (counter) => ({
    title: job.mode === 'flat' ? 'Stage' : 'Workpiece', hot: true,
    lines: [`${gravure.number(counter.edges_per_revolution.value, 9)} edges a ${gravure.turn()}`, drift(counter)],
    step: job.mode === 'flat' ? `× 2^${clock.interpolation_bits}` : `${grouped(clock.encoder_lines)} × 2^${clock.interpolation_bits}, gear ${clock.gear[0]}:${clock.gear[1]}` })));
  if (clock.carriage) {
    place.append(...drive('Carriage', clock.carriage, (counter) => ({ title: 'Carriage', hot: true, lines: [`${counter.feed_pixels} columns = ${gravure.number(counter.feed_um, 6)} µm a revolution`, drift(counter)], step: 'second channel' })));
  }
};

gravure.shareCharts = () => {
  const { pictures, job, verdict } = gravure.data;
  gravure.at('shares-lead').textContent = `${gravure.grouped(verdict.fired_pixels)} pulses of ${gravure.grouped(verdict.pixels)} pixels (${gravure.percent(verdict.fired_pixels / verdict.pixels)}); ${job.fires} fires. An empty layer, an inverted one or a dark strip shows here.`;
  const place = gravure.at('shares-view');
  const chartOf = (heading, values, xName, bars, first) => {
    const holder = gravure.element('div');
    place.append(gravure.element('h3', {}, heading), holder);
    gravure.whenSized(holder, (width) => {
      const most = Math.max(...values, 1e-9);
      const high = most > 0.5 ? 1 : Math.min(1, most * 1.15);
      const frame = gravure.frame(width, 190, { low: bars ? -0.5 : 0, high: bars ? values.length - 0.5 : first.high, name: xName, whole: true, text: (tick) => gravure.grouped(tick) }, { low: 0, high, name: 'fired', text: (tick) => `${gravure.number(100 * tick, 3)} %` }, heading);
      const zero = frame.placeY(0);
      if (bars) {
        const step = (frame.right - frame.left) / values.length;
        values.forEach((value, i) => {
          const rect = gravure.svg('rect', { x: frame.placeX(i) - 0.4 * step, width: Math.max(0.6, 0.8 * step), y: frame.placeY(value), height: zero - frame.placeY(value), fill: 'var(--accent)' });
          rect.append(gravure.svg('title', {}, `layer ${i}: ${gravure.percent(value)}`));
          frame.chart.append(rect);
        });
      } else {
        const line = [];
        values.forEach((value, i) => {
          line.push([frame.placeX((i / values.length) * first.high), frame.placeY(value)], [frame.placeX(((i + 1) / values.length) * first.high), frame.placeY(value)]);
        });
        frame.chart.append(gravure.svg('path', { d: `${gravure.path([[frame.left, zero], ...line, [frame.right, zero]])}Z`, fill: 'var(--accent)', opacity: 0.25 }));
        frame.chart.append(gravure.svg('path', { d: gravure.path(line), fill: 'none', stroke: 'var(--accent)', 'stroke-width': 1.5 }));
      }
      holder.replaceChildren(frame.chart);
    });
  };
  chartOf('Of each layer', pictures.layers.map((layer) => layer.share), 'layer', true, null);
  chartOf('Along the line, all layers', pictures.columns, 'column', false, { high: job.columns });
};
