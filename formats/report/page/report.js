'use strict';
// Figures, job, workpiece, sources; then every part once.

gravure.allGood = () => `All ${gravure.grouped(gravure.data.verdict.lines)} lines were run on the emulated board and put back onto the workpiece: every pixel is where the images have it.`;

gravure.dpi = (um) => `${gravure.number(25400 / um, 5)} DPI`;

gravure.tiles = () => {
  const { job, seam, verdict, error, relief } = gravure.data;
  const { element, number } = gravure;
  const tile = (name, value, more) => element('div', {}, element('dt', {}, name), element('dd', {}, value, element('small', {}, more)));
  const place = gravure.at('tiles');
  place.append(tile('Time', gravure.duration((job.total_s || job.duration_s).value), `${gravure.turns(job.revolutions)}, exact`));
  place.append(tile('Seam, worst', `${number(seam.max_um, 4)} µm`, `limit ${number(seam.limit_um)} µm`));
  if (error) place.append(tile('Landing, at most', `${number(error.max_um, 3)} µm`, error.limit_um === null ? 'no limit set' : `limit ${number(error.limit_um)} µm`));
  place.append(tile('Wrong pixels', verdict.images_compared ? gravure.grouped(verdict.wrong_pixels) : 'not compared', `of ${gravure.grouped(verdict.pixels)}`));
  place.append(tile('Relief, deepest', `${number(relief.deepest, 3)} ${relief.unit === 'um' ? 'µm' : 'pulses'}`, `mean ${number(relief.mean, 3)}`));
};

gravure.jobFacts = () => {
  const { job, relief } = gravure.data;
  const { number, grouped } = gravure;
  const exactly = (value) => (value.exact && value.exact.includes('/') ? ` (exactly ${value.exact})` : '');
  const rows = [['Mode', job.mode], ['Polarity', `${job.fires} fires; lines run along the ${job.lines_along} of the images`]];
  if (job.mode === 'flat') rows.push(['Panel', `${number(job.circumference_mm, 7)} mm across the lines, ${number(job.length_mm, 7)} mm along them`]);
  else rows.push(['Workpiece', `diameter ${number(job.diameter_mm, 7)} mm, circumference ${number(job.circumference_mm, 8)} mm, ${number(job.length_mm, 7)} mm along the axis`]);
  rows.push(['Pixel pitch, along the line', `${number(job.pixel_pitch_um.value, 8)} µm = ${gravure.dpi(job.pixel_pitch_um.value)}`]);
  rows.push(['Line pitch, around', `${number(job.line_pitch_um.value, 8)} µm = ${gravure.dpi(job.line_pitch_um.value)}${exactly(job.line_pitch_um)}`]);
  rows.push(['Image', `${grouped(job.columns)} columns × ${grouped(job.lines_per_revolution)} lines, ${grouped(job.layers)} layer${job.layers === 1 ? '' : 's'}`]);
  if (job.bands) rows.push(['Bands', `${grouped(job.bands)} of ${grouped(job.pixels_per_line)} columns`]);
  rows.push([job.mode === 'flat' ? 'Passes' : 'Revolutions', grouped(job.revolutions)]);
  rows.push(['Time of marking', `${gravure.duration(job.duration_s.value)} = ${grouped(job.ticks)} ticks, exactly`]);
  if (job.total_s) rows.push(['With spin-up and spin-down', gravure.duration(job.total_s.value)]);
  rows.push(['Speeds', `${job.mode === 'flat' ? '' : `${number(job.rpm, 6)} rpm, `}surface ${number(job.surface_mm_s, 6)} mm/s, scan ${number(job.scan_m_s, 6)} m/s`]);
  rows.push(['Lines', job.bidirectional ? `both ways; right-to-left lines ${grouped(job.offset_slots)} slots and ${grouped(job.offset_remainder_ticks)} ticks later` : 'one way']);
  if (relief.removal) {
    const { removal } = relief;
    rows.push(['A pulse', `spot ${number(removal.spot_um)} µm, ${number(removal.fluence_j_cm2)} J/cm², threshold ${number(removal.threshold_j_cm2)} J/cm²: a crater ${number(removal.crater_um, 4)} µm wide and ${number(removal.depth_um, 4)} µm deep`]);
  }
  gravure.at('job-facts').append(gravure.facts(rows));
};

gravure.workpiece = () => {
  const { relief, job } = gravure.data;
  const { element, number } = gravure;
  const unit = relief.unit === 'um' ? 'µm' : 'pulses';
  const place = gravure.at('workpiece-view');
  gravure.at('workpiece-lead').textContent = relief.unit === 'um'
    ? `Expected relief after all layers: ${number(relief.deepest, 4)} µm at the deepest, ${number(relief.mean, 4)} µm on average.`
    : `Pulses after all layers: ${number(relief.deepest, 4)} at most, ${number(relief.mean, 4)} on average. For depths in µm give [laser] ${relief.absent} in the job.`;
  if (typeof gravure3d === 'undefined') {
    place.append(element('p', { class: 'missing', id: 'no-3d' }, 'This build of gravure has no 3-D view: Node.js and npm were not there when it was built. The depth of all layers is shown unrolled, above.'));
    return;
  }
  const view = element('div', { class: 'stage', id: 'view3d' });
  const slider = element('input', { type: 'range', min: 0, max: 100, value: 50, id: 'relief-scale' });
  const output = element('output', { for: 'relief-scale' });
  const reset = element('button', { type: 'button' }, 'Front');
  const bar = element('i');
  bar.style.background = gravure.depthGradient();
  place.append(
    element('div', { class: 'controls' }, element('label', { class: 'wide', for: 'relief-scale' }, 'Relief drawn', slider, output), reset),
    view, element('div', { class: 'scale' }, '0', bar, `${number(relief.deepest, 4)} ${unit}`),
    element('p', { class: 'small' }, 'Drag or use the arrow keys to turn, wheel or + and − to come nearer. The relief is drawn larger than it is.'));
  const scene = window.gravure3d.show(view, {
    cells: gravure.data.pictures.cells,
    linesAreRows: gravure.data.pictures.lines_are_rows,
    depth: gravure.sixteenBits(relief.cells),
    flat: job.mode === 'flat',
    aroundMm: job.circumference_mm,
    lengthMm: job.length_mm,
    colour: gravure.depthColour,
    label: `Workpiece with its relief, ${number(relief.deepest, 4)} ${unit} deep`,
  });
  if (!scene) {
    view.replaceWith(element('p', { class: 'missing', id: 'no-webgl' }, 'This browser has no WebGL: the 3-D view cannot be drawn. The depth of all layers is shown unrolled, above.'));
    return;
  }
  const size = job.mode === 'flat' ? Math.max(job.circumference_mm, job.length_mm) / 2 : job.circumference_mm / (2 * Math.PI);
  const exaggerate = () => {
    const share = 0.25 * (Number(slider.value) / 100) ** 2;  // of the radius
    scene.setDepth(share * size);
    const deepestMm = relief.deepest / 1000;
    output.textContent = relief.unit === 'um' && deepestMm > 0 ? `× ${number((share * size) / deepestMm, 3)}` : `${number(100 * share, 2)} % of the radius`;
  };
  slider.addEventListener('input', exaggerate);
  reset.addEventListener('click', () => scene.reset());
  exaggerate();
  gravure.scene = scene;
};

gravure.sourcesTable = () => {
  const { sources, files } = gravure.data;
  const { element } = gravure;
  const body = element('tbody');
  const most = 200;
  for (const file of files) {
    body.append(element('tr', {}, element('td', {}, file.path), element('td', { class: 'number' }, '–'), element('td', { class: 'number' }, '–'), element('td', { class: 'mono hash' }, file.sha256)));
  }
  for (const source of sources.slice(0, most)) {
    body.append(element('tr', {}, element('td', {}, source.path), element('td', { class: 'number' }, String(source.page)), element('td', { class: 'number' }, `${source.width} × ${source.height}`), element('td', { class: 'mono hash' }, source.sha256)));
  }
  const head = element('thead', {}, element('tr', {}, ...[['file', ''], ['page', 'number'], ['pixels', 'number'], ['SHA-256', '']].map(([name, kind]) => element('th', { scope: 'col', class: kind }, name))));
  const place = gravure.at('sources-table');
  place.append(element('table', {}, head, body));
  if (sources.length > most) place.append(element('p', { class: 'small' }, `and ${sources.length - most} more: gravure inspect --json lists them.`));
};

(() => {
  const { data } = gravure;
  gravure.at('title').textContent = data.job.title || data.program;
  gravure.at('file').textContent = `${data.program} · ${data.job.mode}`;
  gravure.at('footer').textContent = `Made by ${data.generator} from ${data.program}. Proved on an emulated board and computed: nothing on this page was measured on a machine.`;
  for (const part of ['verdict', 'tiles', 'jobFacts', 'seamChart', 'budgetBars', 'clockTree', 'timingView', 'layersView', 'workpiece', 'shareCharts', 'sourcesTable']) gravure[part]();
  document.documentElement.dataset.ready = 'true';
})();
