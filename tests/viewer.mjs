// Another program that shows models: three.js, in a tab of its own.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

const THREE = new URL('node_modules/three/', import.meta.url).pathname;
const PLACE = 'http://viewer.test/';

const HTML = `<!doctype html><style>body { margin: 0 } canvas { display: block }</style>
<script type="importmap">{ "imports": { "three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/" } }</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
const [width, height] = [innerWidth, innerHeight];
const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.setSize(width, height);
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x334455);
scene.add(new THREE.HemisphereLight(0xffffff, 0x445566, 2));
const sun = new THREE.DirectionalLight(0xffffff, 2);
sun.position.set(1, 2, 3);
scene.add(sun);
let model;
let mixer;
const meshes = () => {
  const all = [];
  model.scene.traverse((node) => { if (node.isMesh) all.push(node); });
  return all;
};
const places = () => {
  model.scene.updateMatrixWorld(true);
  const point = new THREE.Vector3();
  return meshes().flatMap((mesh) => {
    const { count } = mesh.geometry.attributes.position;
    return Array.from({ length: count }, (_, i) => mesh.getVertexPosition(i, point).applyMatrix4(mesh.matrixWorld).toArray());
  });
};
const draw = () => {
  const box = new THREE.Box3().setFromPoints(places().map((p) => new THREE.Vector3(...p)));
  const [middle, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3()).length()];
  const camera = new THREE.PerspectiveCamera(30, width / height, size / 100, size * 10);
  camera.position.set(0.3, 0.25, 1).multiplyScalar(size * 1.9).add(middle);
  camera.lookAt(middle);
  renderer.render(scene, camera);
};
globalThis.viewer = {
  async load(base64) {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    model = await new GLTFLoader().parseAsync(bytes.buffer, '');
    scene.add(model.scene);
    mixer = new THREE.AnimationMixer(model.scene);
    for (const clip of model.animations) mixer.clipAction(clip).play();
    draw();
    const box = new THREE.Box3().setFromObject(model.scene);
    return {
      triangles: meshes().reduce((sum, { geometry }) => sum + (geometry.index ?? geometry.attributes.position).count / 3, 0),
      skinned: meshes().every((mesh) => mesh.isSkinnedMesh),
      bones: meshes().flatMap((mesh) => mesh.skeleton?.bones.map((bone) => bone.name) ?? []),
      coloured: meshes().some(({ geometry }) => geometry.attributes.color),
      clips: model.animations.map(({ duration, tracks }) => ({ duration, tracks: tracks.length })),
      size: box.getSize(new THREE.Vector3()).toArray(),
    };
  },
  /** Where the vertices are some seconds into the animation. */
  at(seconds) {
    mixer.setTime(seconds);
    draw();
    return places();
  },
  /** Where they are when a bone is taken elsewhere, in its own coordinates. */
  push(name, by) {
    mixer.stopAllAction();
    let bone;
    model.scene.traverse((node) => { if (node.isBone && node.name === name) bone = node; });
    bone.position.add(new THREE.Vector3(...by));
    draw();
    return places();
  },
};
</script>`;

/** Opens the viewer in a page's browser. */
export async function viewer(sinew) {
  const page = await sinew.page.context().newPage();
  const troubles = [];
  page.on('pageerror', (error) => troubles.push(String(error)));
  await page.route(`${PLACE}**`, async (route) => {
    const path = new URL(route.request().url()).pathname;
    if (path === '/') {
      await route.fulfill({ contentType: 'text/html', body: HTML });
    } else if (path.startsWith('/three/')) {
      const body = await readFile(join(THREE, path.slice('/three/'.length)));
      await route.fulfill({ contentType: 'text/javascript', body });
    } else {
      await route.fulfill({ status: 404, body: '' });
    }
  });
  await page.setViewportSize({ width: 480, height: 480 });
  await page.goto(PLACE);
  await page.waitForFunction(() => globalThis.viewer, undefined, { timeout: 60_000 });
  return {
    page,
    troubles,
    load: (bytes) => page.evaluate((base64) => viewer.load(base64), bytes.toString('base64')),
    at: (seconds) => page.evaluate((seconds) => viewer.at(seconds), seconds),
    push: (name, by) => page.evaluate(([name, by]) => viewer.push(name, by), [name, by]),
    close: () => page.close(),
  };
}
