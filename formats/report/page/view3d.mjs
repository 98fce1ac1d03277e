// The workpiece with its relief, or the pulses on it, turnable. Bundled with three.js; the pages call gravure3d.show() and
// gravure3d.showPoints().
import {
  AmbientLight, BufferAttribute, BufferGeometry, CanvasTexture, Color, DirectionalLight, DoubleSide, Mesh,
  MeshStandardMaterial, PerspectiveCamera, Points, PointsMaterial, RepeatWrapping, Scene, SRGBColorSpace, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

/** Depth by (around, along), both 0 to 1: means of cells, the circumference closed. */
function sampler({ cells: [width, height], linesAreRows, depth }) {
  return (around, along) => {
    const x = Math.min(width - 1, Math.floor((linesAreRows ? along : around) * width));
    const y = Math.min(height - 1, Math.floor((linesAreRows ? around : along) * height));
    return depth[y * width + x];
  };
}

/** Colours of the cells, lines downwards, so that a turned picture needs no other texture coordinates. */
function texture({ cells: [width, height], linesAreRows, depth, colour }) {
  const canvas = document.createElement('canvas');
  canvas.width = linesAreRows ? width : height;
  canvas.height = linesAreRows ? height : width;
  const image = new ImageData(canvas.width, canvas.height);
  for (let y = 0; y < canvas.height; ++y) {
    for (let x = 0; x < canvas.width; ++x) {
      const [red, green, blue] = colour(depth[linesAreRows ? y * width + x : x * width + y]);
      image.data.set([red, green, blue, 255], 4 * (y * canvas.width + x));
    }
  }
  canvas.getContext('2d').putImageData(image, 0, 0);
  const map = new CanvasTexture(canvas);
  map.wrapT = RepeatWrapping;
  map.colorSpace = SRGBColorSpace;
  map.flipY = false;
  map.anisotropy = 4;
  return map;
}

class Workpiece {
  constructor(settings) {
    this.settings = settings;
    const { cells: [width, height], linesAreRows } = settings;
    this.around = Math.max(96, Math.min(512, linesAreRows ? height : width));
    this.along = Math.max(2, Math.min(256, linesAreRows ? width : height));
    this.geometry = new BufferGeometry();
    const count = (this.around + 1) * (this.along + 1);
    this.positions = new Float32Array(3 * count);
    const uv = new Float32Array(2 * count);
    this.depth = new Float32Array(count);
    const at = sampler(settings);
    const index = [];
    for (let a = 0; a <= this.around; ++a) {
      for (let l = 0; l <= this.along; ++l) {
        const i = a * (this.along + 1) + l;
        uv[2 * i] = l / this.along;
        uv[2 * i + 1] = a / this.around;
        const turn = settings.flat ? Math.min(a / this.around, 0.999999) : (a % this.around) / this.around;
        this.depth[i] = at(turn, Math.min(l / this.along, 0.999999));
        if (a < this.around && l < this.along) {
          index.push(i, i + this.along + 1, i + 1, i + 1, i + this.along + 1, i + this.along + 2);
        }
      }
    }
    this.geometry.setAttribute('position', new BufferAttribute(this.positions, 3));
    this.geometry.setAttribute('uv', new BufferAttribute(uv, 2));
    this.geometry.setIndex(index);
    const material = new MeshStandardMaterial({ map: texture(settings), roughness: 0.55, metalness: 0.15, side: DoubleSide });
    this.mesh = new Mesh(this.geometry, material);
  }
  setDepth(mm) {
    const { aroundMm, lengthMm, flat } = this.settings;
    const radius = aroundMm / (2 * Math.PI);
    for (let a = 0; a <= this.around; ++a) {
      const angle = (2 * Math.PI * a) / this.around;
      for (let l = 0; l <= this.along; ++l) {
        const i = a * (this.along + 1) + l;
        const height = -mm * this.depth[i];
        const along = (l / this.along - 0.5) * lengthMm;
        const place = flat
          ? [along, height, (a / this.around - 0.5) * aroundMm]
          : [along, (radius + height) * Math.cos(angle), -(radius + height) * Math.sin(angle)];
        this.positions.set(place, 3 * i);
      }
    }
    this.geometry.attributes.position.needsUpdate = true;
    this.geometry.computeVertexNormals();
    if (!flat) this.closeNormals();
    this.geometry.computeBoundingSphere();
  }
  /** The first and the last row of vertices are the same place. */
  closeNormals() {
    const normals = this.geometry.attributes.normal;
    const last = this.around * (this.along + 1);
    for (let l = 0; l <= this.along; ++l) {
      const sum = new Vector3().fromBufferAttribute(normals, l).add(new Vector3().fromBufferAttribute(normals, last + l)).normalize();
      normals.setXYZ(l, sum.x, sum.y, sum.z);
      normals.setXYZ(last + l, sum.x, sum.y, sum.z);
    }
    normals.needsUpdate = true;
  }
}

/** A scene in `holder` about an object of radius `size`, to be turned and come near to; null where there is no WebGL. */
function stage(holder, label, object, size) {
  let renderer;
  try {
    renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch {
    return null;
  }
  const { canvas } = { canvas: renderer.domElement };
  canvas.tabIndex = 0;
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', label);
  holder.append(canvas);
  const scene = new Scene();
  scene.add(object, new AmbientLight(0xffffff, 1.1));
  const camera = new PerspectiveCamera(32, 1, size / 100, size * 20);
  const key = new DirectionalLight(0xffffff, 2.2);
  key.position.set(-0.6, 1, 0.8);
  const rim = new DirectionalLight(0xffffff, 0.8);
  rim.position.set(1, 0.2, 0.4);
  camera.add(key, rim);
  scene.add(camera);
  const controls = new OrbitControls(camera, canvas);
  controls.enableZoom = false;  // a page that scrolls must not be held; below, and when it has the focus
  const draw = () => renderer.render(scene, camera);
  const reset = () => {
    const distance = (size / Math.sin((16 * Math.PI) / 180)) * Math.max(1, 0.85 / Math.max(0.4, camera.aspect));
    camera.position.copy(new Vector3(0.45, 0.55, 1).normalize().multiplyScalar(distance));
    controls.target.set(0, 0, 0);
    controls.update();
    draw();
  };
  const nearer = (factor) => {
    camera.position.multiplyScalar(factor).clampLength(size * 1.05, size * 12);
    controls.update();
    draw();
  };
  const turn = (x, y) => {
    const sphere = camera.position.clone();
    sphere.applyAxisAngle(new Vector3(0, 1, 0), x);
    const side = new Vector3().crossVectors(new Vector3(0, 1, 0), sphere).normalize();
    const tilted = sphere.clone().applyAxisAngle(side, y);
    if (Math.abs(tilted.clone().normalize().y) < 0.99) sphere.copy(tilted);
    camera.position.copy(sphere);
    controls.update();
    draw();
  };
  canvas.addEventListener('keydown', (event) => {
    const act = {
      ArrowLeft: () => turn(-0.15, 0), ArrowRight: () => turn(0.15, 0), ArrowUp: () => turn(0, -0.15), ArrowDown: () => turn(0, 0.15),
      '+': () => nearer(0.85), '=': () => nearer(0.85), '-': () => nearer(1.18), Home: reset,
    }[event.key];
    if (act) {
      event.preventDefault();
      act();
    }
  });
  canvas.addEventListener('wheel', (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    nearer(event.deltaY > 0 ? 1.1 : 0.9);
  }, { passive: false });
  controls.addEventListener('change', draw);
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const ground = () => {
    scene.background = new Color(dark.matches ? 0x22282a : 0xe9ebe8);
    draw();
  };
  dark.addEventListener('change', ground);
  let first = true;
  const fit = () => {
    const { clientWidth: width, clientHeight: height } = holder;
    if (!width || !height) return;
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (first) reset();
    first = false;
    draw();
  };
  new ResizeObserver(fit).observe(holder);
  fit();
  ground();
  return { draw, reset, turn };
}

/** Shows the workpiece in `holder`; null where there is no WebGL. */
export function show(holder, settings) {
  const workpiece = new Workpiece(settings);
  workpiece.setDepth(0);
  const scene = stage(holder, settings.label, workpiece.mesh, workpiece.geometry.boundingSphere.radius);
  return scene && { ...scene, setDepth: (mm) => { workpiece.setDepth(mm); scene.draw(); } };
}

/** Shows points in `holder`, z upwards: places are shares of the spans of x, y and z; null where there is no WebGL. */
export function showPoints(holder, { spansMm: [x, y, z], shares, label }) {
  const count = shares[0].length;
  const places = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    places.set([(shares[0][i] - 0.5) * x, (shares[2][i] - 0.5) * z, (0.5 - shares[1][i]) * y], 3 * i);
  }
  const colours = new Float32Array(3 * count);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(places, 3));
  geometry.setAttribute('color', new BufferAttribute(colours, 3));
  const material = new PointsMaterial({ size: 2.5, sizeAttenuation: false, vertexColors: true });
  const scene = stage(holder, label, new Points(geometry, material), Math.hypot(x, y, z) / 2 || 1);
  const setColours = (colour) => {
    const mixed = new Color();
    for (let i = 0; i < count; ++i) {
      const [red, green, blue] = colour(i);
      mixed.setRGB(red / 255, green / 255, blue / 255, SRGBColorSpace).toArray(colours, 3 * i);
    }
    geometry.attributes.color.needsUpdate = true;
    scene.draw();
  };
  return scene && { ...scene, setColours };
}
