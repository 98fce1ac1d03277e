'use strict';
// The page of a program that follows a path: figures, surface, axes; then every part once.

gravure.allGood = () => {
  const { verdict } = gravure.data;
  return `All ${gravure.grouped(verdict.fired)} pulses were run on the emulated board and put onto the workpiece by the stored set-points${verdict.points_compared ? ': each within the limits of its wanted point, and every axis within its own.' : '; the program stores no wanted points, so the axes alone are judged.'}`;
};

gravure.tiles = () => {
  const { job, verdict, figures, clock } = gravure.data;
  const { element, number, grouped } = gravure;
  const place = gravure.at('tiles');
  const tile = (name, value, more) => place.append(element('div', {}, element('dt', {}, name), element('dd', {}, value, element('small', {}, more))));
  tile('Pulses', grouped(verdict.fired), `of ${grouped(verdict.pulses)} places, ${number(job.pitch_um.value, 6)} µm apart`);
  tile('Time', gravure.duration(job.duration_s.value), `${grouped(clock.periods)} servo periods`);
  for (const figure of figures.slice(0, 3)) {
    tile(figure.name[0].toUpperCase() + figure.name.slice(1), `${number(figure.max, 4)} ${figure.unit}`, figure.limit === null ? 'no limit given' : `limit ${number(figure.limit, 4)} ${figure.unit}`);
  }
};

gravure.jobFacts = () => {
  const { job, clock } = gravure.data;
  const { number, grouped, hertz } = gravure;
  const rows = [['Mode', job.mode]];
  const zones = job.mode === 'zones';
  gravure.at('job-lead').textContent = zones
    ? 'What will be done: the stages bring one zone after the other under the galvo and stand still while it marks, layer by layer.'
    : 'What will be done: five stages and the galvo follow one path on the surface, together.';
  if (job.surface) rows.push([zones ? 'Contours' : 'Surface', job.surface]);
  if (job.texture) rows.push(['Texture', job.texture]);
  rows.push(['Polarity', gravure.data.verdict.fired < gravure.data.verdict.pulses ? `${job.fires} fires: ${gravure.percent(gravure.data.verdict.fired / gravure.data.verdict.pulses)} of the places` : 'every place fires']);
  rows.push(['Pitch', `a pulse every ${number(job.pitch_um.value, 8)} µm of path`]);
  rows.push(['Time', `${gravure.duration(job.duration_s.value)} = ${grouped(job.ticks)} ticks, exactly`]);
  rows.push(['Clocks', `seed ${hertz(clock.seed_hz)}, FPGA ${hertz(clock.fpga_hz)}; a pulse slot is ${grouped(clock.ticks_per_slot)} ticks (${hertz(clock.pulse_hz.value)}), a servo period ${grouped(clock.slots_per_period)} slots = ${grouped(clock.ticks_per_period)} ticks`]);
  rows.push(['Machine', `stages X Y Z A C, galvo U V${gravure.data.axes.length > 7 ? ', focus axis W' : ''}; signs of the axes as in ${job.signs.replace('_', ' ')}`]);
  for (const source of gravure.data.sources) rows.push([source.path, gravure.element('span', { class: 'mono hash' }, `SHA-256 ${source.sha256}`)]);
  gravure.at('job-facts').append(gravure.facts(rows));
};

/** Bars against a limit: full is the limit, beyond it red. */
gravure.figureBars = () => {
  const { figures, verdict } = gravure.data;
  const { element, number } = gravure;
  gravure.at('figures-lead').textContent = verdict.points_compared
    ? 'Every pulse that fires, put on the workpiece and held against the point wanted there. A full bar is the limit.'
    : 'The program stores no wanted points: focus offset, incidence and landing are not judged. A full bar is the limit.';
  const bars = element('div', { class: 'bars', role: 'list' });
  for (const figure of figures) {
    const share = figure.limit > 0 ? figure.max / figure.limit : null;
    const fill = element('div', { class: `fill ${share > 1 ? 'over' : ''}` });
    fill.style.width = `${Math.min(100, 100 * (share || 0))}%`;
    const track = element('div', { class: 'track' });
    if (share !== null) track.append(fill);
    const limit = figure.limit === null ? 'no limit' : figure.name === 'spacing' ? `half a slot: ${number(figure.limit, 3)}` : `limit ${number(figure.limit, 3)}`;
    bars.append(element('div', { role: 'listitem' }, figure.name), track, element('div', { class: 'value' }, `${number(figure.max, 4)} ${figure.unit}`, element('small', {}, ` ${limit}`)));
  }
  const place = gravure.at('figure-bars');
  place.append(bars);
  const body = element('tbody');
  for (const figure of figures) {
    body.append(element('tr', {}, element('td', {}, figure.name), element('td', { class: 'number' }, `${number(figure.max, 6)} ${figure.unit}`), element('td', { class: 'number' }, `${number(figure.rms, 6)} ${figure.unit}`), element('td', { class: 'number' }, figure.worst_pulse === null ? '–' : gravure.grouped(figure.worst_pulse))));
  }
  const head = element('thead', {}, element('tr', {}, ...['figure', 'at most', 'rms', 'worst pulse'].map((name, i) => element('th', { scope: 'col', class: i ? 'number' : '' }, name))));
  place.append(element('div', { class: 'scroll after' }, element('table', {}, head, body)));
  place.append(element('p', { class: 'small' }, 'Spacing: how far along the path a pulse fires from its place; half a slot is what the clock leaves.'));
};

/** The pulses seen along z, in cells as large as it takes for them to join. */
gravure.mapView = () => {
  const { map } = gravure.data;
  const { element, number } = gravure;
  const place = gravure.at('map-view');
  const [width, height] = map.cells;
  if (!(width > 0 && height > 0)) {
    gravure.at('map-lead').textContent = 'No pulse fires.';
    return;
  }
  const pulses = gravure.sixteenBits(map.pulses).map((share) => share * map.most);
  const heights = gravure.sixteenBits(map.heights).map((share) => share * (map.highest_mm - map.lowest_mm));
  let join = 1;  // cells a side of what is drawn
  const joined = () => {
    const columns = Math.ceil(width / join);
    const rows = Math.ceil(height / join);
    const cells = { columns, rows, pulses: new Float64Array(columns * rows), heights: new Float64Array(columns * rows) };
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const to = Math.floor(y / join) * columns + Math.floor(x / join);
        cells.pulses[to] += pulses[y * width + x];
        cells.heights[to] += pulses[y * width + x] * heights[y * width + x];
      }
    }
    return cells;
  };
  let cells = joined();
  while (cells.pulses.filter((count) => count > 0).length < 0.15 * cells.pulses.length && cells.columns * cells.rows > 4000) {
    join *= 2;
    cells = joined();
  }
  const most = cells.pulses.reduce((high, count) => Math.max(high, count), 0);
  gravure.at('map-lead').textContent = `Where the pulses landed, seen along z: ${number(width * map.cell_mm, 4)} × ${number(height * map.cell_mm, 4)} mm from x ${number(map.left_mm, 5)}, y ${number(map.bottom_mm, 5)} mm; the surface there is ${number(map.lowest_mm, 5)} to ${number(map.highest_mm, 5)} mm high.`;
  const select = element('select', { id: 'map-what' }, element('option', { value: 'pulses' }, 'pulses'), element('option', { value: 'heights' }, 'height of the surface'));
  const canvas = element('canvas', { id: 'map-canvas', width: cells.columns, height: cells.rows, role: 'img', 'aria-label': 'Pulses on the surface, seen along z' });
  const bar = element('i');
  bar.style.background = gravure.depthGradient();
  const low = element('span');
  const high = element('span');
  const draw = () => {
    const asHeight = select.value === 'heights';
    const context = canvas.getContext('2d');
    const image = context.createImageData(cells.columns, cells.rows);
    const span = map.highest_mm - map.lowest_mm;
    cells.pulses.forEach((count, i) => {
      const colour = count > 0 ? gravure.depthColour(asHeight ? 0.08 + 0.92 * (span > 0 ? cells.heights[i] / count / span : 0) : 0.25 + (0.75 * count) / most) : [233, 235, 232];
      image.data.set([...colour, 255], 4 * i);
    });
    context.putImageData(image, 0, 0);
    low.textContent = asHeight ? `${number(map.lowest_mm, 4)} mm` : '0';
    high.textContent = asHeight ? `${number(map.highest_mm, 4)} mm` : `${gravure.grouped(Math.round(most))} ${Math.round(most) === 1 ? 'pulse' : 'pulses'} in a cell of ${number(1000 * join * map.cell_mm, 4)} µm`;
  };
  canvas.style.aspectRatio = `${cells.columns} / ${cells.rows}`;
  canvas.style.maxWidth = `${Math.min(640, (640 * cells.columns) / cells.rows)}px`;
  canvas.style.imageRendering = 'pixelated';
  const stage = element('div', { class: 'stage map' }, canvas);
  stage.style.width = canvas.style.maxWidth;
  canvas.style.cursor = 'default';
  select.addEventListener('change', draw);
  place.append(element('div', { class: 'controls' }, element('label', { for: 'map-what' }, 'Colours', select)), stage, element('div', { class: 'scale' }, low, bar, high));
  draw();
};

/** The pulses where they landed, to be turned; thinned evenly where there are more than a page holds. */
gravure.workpiece = () => {
  const { sample, verdict } = gravure.data;
  const { element, number, grouped } = gravure;
  const place = gravure.at('workpiece-view');
  const [x, y, z] = sample.axes;
  const range = ({ least_mm: least, span_mm: span }) => `${number(least, 5)} to ${number(least + span, 5)}`;
  const which = sample.every === 1 ? `All ${grouped(sample.shown)} pulses` : `One pulse in ${grouped(sample.every)} of ${grouped(verdict.fired)}, ${grouped(sample.shown)} points,`;
  gravure.at('workpiece-lead').textContent = sample.shown
    ? `${which} where the stored set-points put them on the workpiece: x ${range(x)}, y ${range(y)}, z ${range(z)} mm. z points up, nothing is drawn larger than it is.`
    : 'No pulse fires.';
  if (!sample.shown) return;
  if (typeof gravure3d === 'undefined') {
    place.append(element('p', { class: 'missing', id: 'no-3d' }, 'This build of gravure has no 3-D view: Node.js and npm were not there when it was built. The pulses are shown from above, as heights, under On the surface.'));
    return;
  }
  const shares = sample.axes.map((axis) => gravure.sixteenBits(axis.at));
  const view = element('div', { class: 'stage', id: 'view3d' });
  const select = element('select', { id: 'points-what' }, element('option', { value: 'order' }, 'order of marking'), element('option', { value: 'height' }, 'height'));
  const reset = element('button', { type: 'button' }, 'Front');
  const bar = element('i');
  bar.style.background = gravure.depthGradient();
  const low = element('span');
  const high = element('span');
  place.append(element('div', { class: 'controls' }, element('label', { for: 'points-what' }, 'Colours', select), reset), view, element('div', { class: 'scale' }, low, bar, high),
    element('p', { class: 'small' }, 'Drag or use the arrow keys to turn, wheel or + and − to come nearer.'));
  const scene = window.gravure3d.showPoints(view, {
    spansMm: sample.axes.map((axis) => axis.span_mm),
    shares,
    label: `${grouped(sample.shown)} pulses on the workpiece`,
  });
  if (!scene) {
    view.replaceWith(element('p', { class: 'missing', id: 'no-webgl' }, 'This browser has no WebGL: the 3-D view cannot be drawn. The pulses are shown from above, as heights, under On the surface.'));
    return;
  }
  const paint = () => {
    const byHeight = select.value === 'height';
    scene.setColours((i) => gravure.depthColour(0.15 + 0.85 * (byHeight ? shares[2][i] : i / Math.max(1, sample.shown - 1))));
    low.textContent = byHeight ? `${number(z.least_mm, 4)} mm` : 'first pulse';
    high.textContent = byHeight ? `${number(z.least_mm + z.span_mm, 4)} mm` : 'last pulse';
  };
  select.addEventListener('change', paint);
  reset.addEventListener('click', () => scene.reset());
  paint();
  gravure.scene = scene;
};

gravure.clockTree = () => {
  const { clock, job } = gravure.data;
  const { grouped, hertz } = gravure;
  const perSecond = clock.fpga_hz / clock.ticks_per_period;
  gravure.at('clock-tree').append(...gravure.branch('Light and set-points', [
    { title: 'Seed laser', lines: [hertz(clock.seed_hz)] },
    { title: 'FPGA clock', lines: [hertz(clock.fpga_hz)], step: `× j = ${clock.multiplier}` },
    { title: 'Pulse slot', lines: [`${grouped(clock.ticks_per_slot)} ticks`, `${hertz(clock.pulse_hz.value)} of places in time`], step: `÷ j k = ${clock.multiplier} × ${clock.pulse_divider}` },
    { title: 'Servo period', lines: [`${grouped(clock.ticks_per_period)} ticks`, `${gravure.number(perSecond, 7)} set-points/s`], step: `÷ ${grouped(clock.slots_per_period)} slots` },
    { title: 'Job', lines: [`${grouped(job.ticks)} ticks`, gravure.duration(job.duration_s.value)], step: `× ${grouped(clock.periods)} periods`, hot: true }]));
};

gravure.periodTiming = () => {
  const { line, clock } = gravure.data;
  gravure.timingView({
    line,
    clock: { ...clock, slots_per_line: clock.slots_per_period, ticks_per_line: clock.ticks_per_period },
    job: { pixels_per_line: clock.slots_per_period },
  }, 'servo period', []);
  gravure.at('timing-view').append(gravure.element('p', { class: 'small' }, 'U and V: the set-points at the begin and the end of the period, joined straight. A pulse fires in the slot in which the path has come a pitch further.'));
};

gravure.axisTable = () => {
  const { axes } = gravure.data;
  const { element, number } = gravure;
  const body = element('tbody');
  let some = false;
  const cell = (text, more, over) => element('td', { class: over ? 'number over' : 'number' }, text, element('small', {}, more));
  for (const axis of axes) {
    // As `verify` judges: a limit allows for what the rounding of set-points to counts may add.
    const used = ([value, limit, rounding], unit) => {
      const over = limit !== null && value > limit * 1.000001 + rounding;
      const rounded = limit !== null && !over && value > limit * 1.000001;
      some = some || rounded;
      return cell(`${number(value, 4)} ${unit}`, limit === null ? 'no limit' : `${gravure.percent(value / limit)} of ${number(limit, 4)}${rounded ? ' *' : ''}`, over);
    };
    const travel = axis.least_allowed === null && axis.most_allowed === null ? 'no limit' : `of ${number(axis.least_allowed, 5)} to ${number(axis.most_allowed, 5)}`;
    body.append(element('tr', {}, element('th', { scope: 'row' }, axis.name), cell(`${number(axis.from, 5)} to ${number(axis.to, 5)} ${axis.unit}`, travel), used(axis.speed, `${axis.unit}/s`), used(axis.acceleration, `${axis.unit}/s²`), used(axis.jerk, `${axis.unit}/s³`)));
  }
  const head = element('thead', {}, element('tr', {}, ...['axis', 'travel', 'speed', 'acceleration', 'jerk'].map((name, i) => element('th', { scope: 'col', class: i ? 'number' : '' }, name))));
  gravure.at('axis-table').append(element('table', { class: 'axes' }, head, body));
  if (some) gravure.at('axis-table').append(element('p', { class: 'small' }, '* Beyond its limit by no more than the rounding of set-points to counts makes, for which limits allow.'));
};

/** Each axis against time: the band between the least and the greatest set-point of every stretch. */
gravure.traceCharts = () => {
  const { axes, job } = gravure.data;
  const end = job.duration_s.value;
  const stretches = axes[0].trace.least.length;
  gravure.at('traces-lead').textContent = `Set-points in ${gravure.grouped(stretches)} equal stretches of ${gravure.number(end / Math.max(1, stretches), 3)} s, each from its least to its greatest.`;
  const place = gravure.at('trace-charts');
  place.classList.add('traces');
  for (const axis of axes) {
    const { least, most } = axis.trace;
    const holder = gravure.element('div', { class: 'trace' });
    place.append(holder);
    gravure.whenSized(holder, (width) => {
      const low = Math.min(...least);
      const high = Math.max(...most);
      const room = Math.max(0.06 * (high - low), 1e-4);  // an axis that stands still is drawn as one that does
      const frame = gravure.frame(width, 190, { low: 0, high: end || 1, name: 's' }, { low: low - room, high: high + room, name: `${axis.name}, ${axis.unit}` }, `Axis ${axis.name} over time: ${gravure.number(low, 6)} to ${gravure.number(high, 6)} ${axis.unit}`);
      const at = (i) => frame.placeX(((i + 0.5) / stretches) * end);
      const upper = most.map((value, i) => [at(i), frame.placeY(value)]);
      const lower = least.map((value, i) => [at(i), frame.placeY(value)]).reverse();
      frame.chart.append(gravure.svg('path', { class: 'band', d: `${gravure.path([...upper, ...lower])}Z`, fill: 'var(--accent)', stroke: 'var(--accent)', 'stroke-width': 1.2, 'stroke-linejoin': 'round' }));
      holder.replaceChildren(frame.chart);
    });
  }
};

gravure.absent = () => {
  const { element } = gravure;
  const list = element('ul');
  for (const [what, why] of [
    ['Seam error and A-B clocks', 'no axis is driven by the A-B signal: stages and galvo follow set-points, and there is no revolution that could fail to close.'],
    ['Error budget', 'its ten causes are those of a turning workpiece; what is known of each pulse here stands under Pulses.'],
    ['Unrolled layers and fired share', 'the pulses follow one path, not the rows of images; the picture of the surface takes their place.'],
    ['Expected relief', 'pulses lie a pitch apart along a path and once only, and the job does not say what a pulse removes.'],
  ]) list.append(element('li', {}, element('b', {}, what), `: ${why}`));
  gravure.at('absent-list').append(list);
};

(() => {
  const { data } = gravure;
  gravure.at('title').textContent = data.job.title || data.program;
  gravure.at('file').textContent = `${data.program} · ${data.job.mode}`;
  gravure.at('footer').textContent = `Made by ${data.generator} from ${data.program}. Proved on an emulated board and computed: nothing on this page was measured on a machine.`;
  for (const part of ['verdict', 'tiles', 'jobFacts', 'figureBars', 'mapView', 'workpiece', 'clockTree', 'periodTiming', 'axisTable', 'traceCharts', 'absent']) gravure[part]();
  document.documentElement.dataset.ready = 'true';
})();
