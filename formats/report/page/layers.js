'use strict';
// The unrolled layers: slider, zoom to pixels, the seam joined; one layer, or all of them as depth.

/** Draws cells into a canvas of their own: `colour` gives red, green and blue of a share. */
gravure.paint = (width, height, shares, colour) => {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const image = new ImageData(width, height);
  for (let i = 0; i < width * height; ++i) {
    const [red, green, blue] = colour(shares[i]);
    image.data.set([red, green, blue, 255], 4 * i);
  }
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
};
gravure.firedColour = (share) => {
  const light = [246, 245, 240];
  const dark = [26, 32, 38];
  return light.map((low, k) => Math.round(low + (dark[k] - low) * share));
};

gravure.layersView = () => {
  const { pictures, job, seam, sources, relief } = gravure.data;
  const { element, number, grouped } = gravure;
  const shown = pictures.layers.filter((layer) => layer.png);
  const [cellsX, cellsY] = pictures.cells;
  const exact = cellsX === pictures.width && cellsY === pictures.height;
  const around = pictures.lines_are_rows ? 'downwards' : 'to the right';
  gravure.at('layers-lead').textContent = `As the emulated board exposes them, ${pictures.width} × ${pictures.height} pixels, once round the workpiece ${around}. ${exact ? 'Every pixel is shown.' : `A cell is the average of ${number(pictures.width / cellsX, 3)} × ${number(pictures.height / cellsY, 3)} pixels; at the seam every pixel is shown.`} Dark is fired.`;
  const place = gravure.at('layers-view');
  const state = { layer: 0, what: 'layer', where: 'whole', join: true, scale: 1, x: 0, y: 0, picture: null };
  gravure.layers = state;

  const slider = element('input', { type: 'range', min: 0, max: Math.max(0, shown.length - 1), value: 0, id: 'layer-slider', 'aria-label': 'Layer' });
  const select = (id, name, options) => {
    const node = element('select', { id }, ...options.map(([value, text]) => element('option', { value }, text)));
    return [element('label', { for: id }, name, node), node];
  };
  const [whatLabel, what] = select('layers-what', 'Show', [['layer', 'one layer'], ['depth', 'all layers as depth']]);
  const [whereLabel, where] = select('layers-where', 'of', [['whole', 'the whole circumference'], ['seam', 'the seam, pixel by pixel']]);
  if (job.mode === 'flat') {
    where.options[0].textContent = 'the whole panel';
    where.options[1].textContent = 'last and first lines';
  }
  const join = element('input', { type: 'checkbox', id: 'layers-join', checked: true });
  const joinLabel = element('label', {}, join, 'seam in the middle');
  const buttons = element('span', { class: 'buttons', role: 'group', 'aria-label': 'Zoom' });
  const canvas = element('canvas', { id: 'layers-canvas', tabindex: 0, role: 'img' });
  const stage = element('div', { class: 'stage' }, canvas);
  const readout = element('p', { class: 'readout', id: 'layers-readout', 'aria-live': 'polite' });
  const scale = element('div', { class: 'scale' });
  place.append(
    element('div', { class: 'controls' }, element('label', { class: 'wide', for: 'layer-slider' }, 'Layer', slider)),
    element('div', { class: 'controls' }, whatLabel, whereLabel, joinLabel, buttons), stage, scale, readout);

  // Pictures are decoded when they are asked for, and kept.
  const decoded = new Map();
  const sharesOf = async (base64, width, height) => {
    if (!decoded.has(base64)) {
      const image = new Image();
      image.src = `data:image/png;base64,${base64}`;
      await image.decode();
      const scratch = document.createElement('canvas');
      scratch.width = width;
      scratch.height = height;
      const context = scratch.getContext('2d', { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      const rgba = context.getImageData(0, 0, width, height).data;
      const shares = new Float32Array(width * height);
      for (let i = 0; i < shares.length; ++i) shares[i] = rgba[4 * i] / 255;
      if (decoded.size > 12) decoded.delete(decoded.keys().next().value);
      decoded.set(base64, shares);
    }
    return decoded.get(base64);
  };
  const depth = { whole: gravure.sixteenBits(relief.cells), seam: gravure.sixteenBits(relief.seam) };

  /** The picture that is asked for: cells, their shares, and how large one is on the workpiece. */
  const load = async () => {
    const layer = shown[state.layer];
    const whole = state.where === 'whole';
    const width = whole ? cellsX : pictures.seam.width;
    const height = whole ? cellsY : pictures.seam.height;
    const asDepth = state.what === 'depth';
    const shares = asDepth ? depth[state.where] : await sharesOf(whole ? layer.png : layer.seam_png, width, height);
    const pixelX = pictures.lines_are_rows ? job.pixel_pitch_um.value : job.line_pitch_um.value;
    const pixelY = pictures.lines_are_rows ? job.line_pitch_um.value : job.pixel_pitch_um.value;
    const cellX = whole ? (pictures.width / width) * pixelX : pixelX;
    const cellY = whole ? (pictures.height / height) * pixelY : pixelY;
    state.picture = { width, height, shares, cellX, cellY, whole, asDepth, bitmap: gravure.paint(width, height, shares, asDepth ? gravure.depthColour : gravure.firedColour) };
  };
  const most = () => (state.where === 'whole' ? relief.deepest : relief.seam_deepest);
  const caption = () => {
    const layer = shown[state.layer];
    const unit = relief.unit === 'um' ? 'µm' : 'pulses';
    scale.replaceChildren();
    if (state.what === 'depth') {
      const bar = element('i');
      bar.style.background = gravure.depthGradient();
      scale.append(`0`, bar, `${number(most(), 4)} ${unit}`);
      return `All ${grouped(pictures.layers.length)} layers, ${gravure.turns(pictures.exposures)} in all`;
    }
    const source = sources[layer.source];
    return `Layer ${layer.layer} of 0 to ${pictures.layers.length - 1}: ${gravure.percent(layer.share)} fired, ${gravure.turns(layer.revolutions)}; ${source.path}${source.page ? ` page ${source.page}` : ''}${layer.level ? ` level ${layer.level}` : ''}`;
  };

  /** How the picture lies in the canvas: pixels of the screen for each um at zoom 1, and where the seam is. */
  const layout = () => {
    const { picture } = state;
    const wide = picture.width * picture.cellX;
    const high = picture.height * picture.cellY;
    const base = Math.min(canvas.width / wide, canvas.height / high);
    const unit = base * state.scale;
    return { unit, wide: wide * unit, high: high * unit };
  };
  const isJoined = () => state.picture.whole && state.join && job.mode !== 'flat';
  const draw = () => {
    const { picture } = state;
    if (!picture || !canvas.width) return;
    const context = canvas.getContext('2d');
    context.fillStyle = '#c9cdca';
    context.fillRect(0, 0, canvas.width, canvas.height);
    const { unit, wide, high } = layout();
    // The picture stays in sight.
    const limit = (value, size, room) => (size <= room ? (room - size) / 2 : Math.min(0, Math.max(room - size, value)));
    state.x = limit(state.x, wide, canvas.width);
    state.y = limit(state.y, high, canvas.height);
    context.imageSmoothingEnabled = unit * Math.min(picture.cellX, picture.cellY) < 1;
    context.save();
    context.beginPath();
    context.rect(state.x, state.y, wide, high);
    context.clip();
    if (!isJoined()) {
      context.drawImage(picture.bitmap, state.x, state.y, wide, high);
    } else if (pictures.lines_are_rows) {
      const half = Math.floor(picture.height / 2) / picture.height;
      context.drawImage(picture.bitmap, state.x, state.y - (1 - half) * high, wide, high);
      context.drawImage(picture.bitmap, state.x, state.y + half * high, wide, high);
    } else {
      const half = Math.floor(picture.width / 2) / picture.width;
      context.drawImage(picture.bitmap, state.x - (1 - half) * wide, state.y, wide, high);
      context.drawImage(picture.bitmap, state.x + half * wide, state.y, wide, high);
    }
    context.restore();
    drawSeam(context, wide, high);
    canvas.setAttribute('aria-label', caption());
    readout.textContent = caption();
  };
  const drawSeam = (context, wide, high) => {
    const { picture } = state;
    if (picture.whole && !isJoined()) return;
    const rows = pictures.lines_are_rows;
    const cells = rows ? picture.height : picture.width;
    const share = Math.floor(cells / 2) / cells;
    const ratio = canvas.width / canvas.clientWidth;
    context.strokeStyle = '#d4352b';
    context.lineWidth = Math.max(1, ratio);
    context.setLineDash([6 * ratio, 5 * ratio]);
    context.beginPath();
    if (rows) {
      context.moveTo(state.x, state.y + share * high);
      context.lineTo(state.x + wide, state.y + share * high);
    } else {
      context.moveTo(state.x + share * wide, state.y);
      context.lineTo(state.x + share * wide, state.y + high);
    }
    context.stroke();
    context.setLineDash([]);
    const text = job.mode === 'flat' ? 'last line | first line' : `seam: ${number(seam.max_um, 3)} µm at worst`;
    context.font = `${12 * ratio}px system-ui, sans-serif`;
    const x = rows ? Math.max(0, state.x) + 6 * ratio : state.x + share * wide + 6 * ratio;
    const y = rows ? state.y + share * high - 6 * ratio : Math.max(0, state.y) + 16 * ratio;
    context.fillStyle = 'rgba(255, 255, 255, 0.92)';
    context.fillRect(x - 4 * ratio, y - 13 * ratio, context.measureText(text).width + 8 * ratio, 17 * ratio);
    context.fillStyle = '#a01810';
    context.fillText(text, x, y);
  };
  const zoom = (factor, x = canvas.width / 2, y = canvas.height / 2) => {
    const before = state.scale;
    const { picture } = state;
    const cell = layout().unit * Math.max(picture.cellX, picture.cellY) / before;  // of the screen, at zoom 1
    state.scale = Math.min(Math.max(1, (40 * canvas.width / canvas.clientWidth) / cell), Math.max(1, before * factor));
    state.x = x - ((x - state.x) * state.scale) / before;
    state.y = y - ((y - state.y) * state.scale) / before;
    draw();
  };
  const move = (dx, dy) => {
    state.x += dx;
    state.y += dy;
    draw();
  };
  const reset = () => {
    state.scale = 1;
    state.x = 0;
    state.y = 0;
  };
  const button = (text, label, act) => {
    const node = element('button', { type: 'button', 'aria-label': label, title: label }, text);
    node.addEventListener('click', act);
    buttons.append(node);
  };
  button('−', 'Zoom out', () => zoom(0.5));
  button('+', 'Zoom in', () => zoom(2));
  button('Whole', 'Show the whole picture', () => { reset(); draw(); });

  /** Strips that are much longer than wide begin enlarged, their middle in sight. */
  const comeNear = () => {
    const { wide, high } = layout();
    state.scale = Math.max(1, Math.min(40, 0.3 * Math.max(canvas.width / wide, canvas.height / high)));
    state.x = (canvas.width - wide * state.scale) / 2;
    state.y = (canvas.height - high * state.scale) / 2;
  };
  let turn = 0;
  const update = async (anew) => {
    const mine = ++turn;
    joinLabel.hidden = state.where !== 'whole' || job.mode === 'flat';
    slider.disabled = state.what === 'depth';
    if (anew) reset();
    await load();
    if (mine === turn) {
      fit();
      if (anew) comeNear();
      draw();
    }
  };
  const fit = () => {
    const ratio = window.devicePixelRatio || 1;
    const width = stage.clientWidth;
    const { picture } = state;
    const aspect = (picture.height * picture.cellY) / (picture.width * picture.cellX);
    const height = Math.round(Math.min(Math.max(width * aspect, 220), Math.max(320, window.innerHeight * 0.7)));
    canvas.style.height = `${height}px`;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  };
  slider.addEventListener('input', () => { state.layer = Number(slider.value); update(false); });
  what.addEventListener('change', () => { state.what = what.value; update(false); });
  where.addEventListener('change', () => { state.where = where.value; update(true); });
  join.addEventListener('change', () => { state.join = join.checked; draw(); });
  const placeOf = (event) => {
    const box = canvas.getBoundingClientRect();
    return [((event.clientX - box.left) * canvas.width) / box.width, ((event.clientY - box.top) * canvas.height) / box.height];
  };
  canvas.addEventListener('wheel', (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    zoom(event.deltaY > 0 ? 0.8 : 1.25, ...placeOf(event));
  }, { passive: false });
  canvas.addEventListener('pointermove', (event) => {
    const { picture } = state;
    if (!picture || event.buttons) return;
    const { wide, high } = layout();
    const [x, y] = placeOf(event);
    let column = Math.floor(((x - state.x) / wide) * picture.width);
    let row = Math.floor(((y - state.y) / high) * picture.height);
    if (column < 0 || row < 0 || column >= picture.width || row >= picture.height) return;
    if (isJoined()) {
      if (pictures.lines_are_rows) row = (row + picture.height - Math.floor(picture.height / 2)) % picture.height;
      else column = (column + picture.width - Math.floor(picture.width / 2)) % picture.width;
    }
    const share = picture.shares[row * picture.width + column];
    let spot;
    if (picture.whole) {
      spot = `column ${grouped(Math.floor((column * pictures.width) / picture.width))}, row ${grouped(Math.floor((row * pictures.height) / picture.height))} of the image`;
    } else {
      const [line, along] = pictures.lines_are_rows ? [row, column] : [column, row];
      const each = pictures.seam.lines_each;
      spot = `line ${grouped(line < each ? job.lines_per_revolution - each + line : line - each)}, column ${grouped(pictures.seam.first_column + along)}`;
    }
    const unit = relief.unit === 'um' ? 'µm' : 'pulses';
    readout.textContent = `${spot}: ${picture.asDepth ? `${number(share * most(), 4)} ${unit}` : picture.whole && !exact ? `${gravure.percent(share)} fired` : share > 0.5 ? 'fired' : 'dark'}`;
  });
  canvas.addEventListener('keydown', (event) => {
    const step = canvas.width / 8;
    const act = { '+': () => zoom(2), '=': () => zoom(2), '-': () => zoom(0.5), ArrowLeft: () => move(step, 0), ArrowRight: () => move(-step, 0), ArrowUp: () => move(0, step), ArrowDown: () => move(0, -step), Home: () => { reset(); draw(); } }[event.key];
    if (act) {
      event.preventDefault();
      act();
    }
  });
  gravure.whenDragged(canvas, {
    move: (dx, dy) => { const ratio = canvas.width / canvas.clientWidth; move(dx * ratio, dy * ratio); },
    pinch: (factor, x, y) => { const ratio = canvas.width / canvas.clientWidth; zoom(factor, x * ratio, y * ratio); },
  });
  if (shown.length < pictures.layers.length) place.append(element('p', { class: 'small' }, `${shown.length} of ${pictures.layers.length} layers are on this page, evenly chosen; gravure preview --layer shows any.`));
  gravure.whenSized(stage, () => { if (state.picture) { fit(); draw(); } });
  state.ready = update(true);
};
