// Plays the mill: the frames of the page's JSON, on demand. Lengths in millimetres, times in milliseconds.
"use strict";

const textOf = (id) => document.getElementById(id).textContent;

/** The balls. Returns a function that puts them where they are between two frames. */
function addBalls(scene, spheres) {
  const size = 3 * spheres.radii.length, places = Float32Array.from(spheres.places);
  const colours = spheres.colours.flatMap((colour) => new THREE.Color(colour).toArray());
  const place = new THREE.InstancedBufferAttribute(new Float32Array(size), 3).setUsage(THREE.DynamicDrawUsage);
  const square = new THREE.PlaneBufferGeometry(2.4, 2.4); // the ball has radius 1; the rest is room for its soft edge
  const squares = new THREE.InstancedBufferGeometry().copy(square);
  squares.setAttribute("place", place);
  squares.setAttribute("radius", new THREE.InstancedBufferAttribute(Float32Array.from(spheres.radii), 1));
  squares.setAttribute("colour", new THREE.InstancedBufferAttribute(Float32Array.from(colours), 3));
  const mesh = new THREE.Mesh(squares, new THREE.ShaderMaterial({
    vertexShader: textOf("ball-vertex"), fragmentShader: textOf("ball-fragment"), transparent: true, extensions: { derivatives: true } }));
  mesh.frustumCulled = false; // its bounds are those of one square at the origin
  scene.add(mesh);
  return (frame, share) => {
    const from = size * frame, to = from + size;
    for (let k = 0; k < size; ++k) place.array[k] = (1 - share) * places[from + k] + share * places[to + k];
    place.needsUpdate = true;
  };
}

/** The vessel. Returns a function that puts it where it is between two frames. */
function addVessel(scene, vessel) {
  const walls = new THREE.BufferGeometry();
  walls.setAttribute("position", new THREE.Float32BufferAttribute(vessel.points, 3));
  walls.setIndex(vessel.triangles);
  walls.computeVertexNormals(); // curved walls look smooth: their faces share corners, walls do not
  const mesh = new THREE.Mesh(
    walls,
    new THREE.MeshLambertMaterial({
      color: vessel.colour, opacity: vessel.opacity, transparent: true, depthWrite: false, side: THREE.DoubleSide }));
  mesh.renderOrder = 1; // after the balls, which are seen through it
  scene.add(mesh);
  const place = new THREE.Vector3(), turn = new THREE.Quaternion();
  const points = walls.getAttribute("position");
  const movePiston = ({ first, count, shifts }, frame, share) => {
    for (let k = 3 * first; k < 3 * (first + count); ++k) {
      const from = 3 * frame + k % 3;
      points.array[k] = vessel.points[k] + (1 - share) * shifts[from] + share * shifts[from + 3];
    }
    points.needsUpdate = true;
  };
  return (frame, share) => {
    for (const piston of vessel.pistons) movePiston(piston, frame, share);
    mesh.position.fromArray(vessel.poses, 7 * frame).lerp(place.fromArray(vessel.poses, 7 * (frame + 1)), share);
    mesh.quaternion.fromArray(vessel.poses, 7 * frame + 3).slerp(turn.fromArray(vessel.poses, 7 * (frame + 1) + 3), share);
  };
}

/** Who looks, with a lamp over the shoulder. */
function addCamera(scene, eye, target) {
  const camera = new THREE.PerspectiveCamera(0.6 * 180 / Math.PI); // what the vessel sweeps just fills it
  camera.position.fromArray(eye);
  const distance = camera.position.distanceTo(new THREE.Vector3().fromArray(target));
  camera.near = distance / 50;
  camera.far = 10 * distance;
  const lamp = new THREE.DirectionalLight(0xffffff, 0.7);
  lamp.position.set(-0.4, 0.7, 1);
  lamp.target = camera;
  camera.add(lamp);
  scene.add(camera, new THREE.AmbientLight(0xffffff, 0.5));
  return camera;
}

/** Who looks, and a function that draws the mill at a fraction of its playback. */
function makePicture(renderer, mill) {
  const scene = new THREE.Scene(), camera = addCamera(scene, mill.eye, mill.target);
  const moveBalls = addBalls(scene, mill.spheres), moveVessel = addVessel(scene, mill.vessel);
  const steps = mill.vessel.poses.length / 7 - 1;
  const draw = (fraction) => {
    const frame = Math.min(Math.floor(fraction * steps), steps - 1), share = fraction * steps - frame;
    moveBalls(frame, share);
    moveVessel(frame, share);
    renderer.render(scene, camera);
  };
  return { camera, draw };
}

/** Turning and coming nearer with the mouse or fingers. */
function addControls(camera, canvas, target, onChange) {
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false; // its keys would move the mill sideways
  canvas.tabIndex = 0;
  controls.maxDistance = camera.far / 2;
  controls.target.fromArray(target);
  controls.update();
  controls.addEventListener("change", onChange);
  const turn = { ArrowLeft: [-1, 0, 1], ArrowRight: [1, 0, 1], ArrowUp: [0, -1, 1], ArrowDown: [0, 1, 1], "+": [0, 0, 0.9], "-": [0, 0, 1 / 0.9] };
  canvas.addEventListener("keydown", (event) => {
    const step = turn[event.key];
    if (!step) return;
    event.preventDefault(); // the page stays where it is
    const from = new THREE.Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    from.theta += 0.1 * step[0];
    from.phi = Math.min(Math.max(from.phi + 0.1 * step[1], 0.01), Math.PI - 0.01);
    from.radius = Math.min(from.radius * step[2], controls.maxDistance);
    camera.position.setFromSpherical(from).add(controls.target);
    controls.update();
    onChange();
  });
}

function play(renderer) {
  const mill = JSON.parse(textOf("frames"));
  const stage = document.querySelector(".stage"), canvas = renderer.domElement;
  const button = document.getElementById("play"), slider = document.getElementById("time");
  const clock = document.getElementById("clock");
  const end = Number(slider.max), { camera, draw } = makePicture(renderer, mill);
  const decimals = Math.max(0, 3 - Math.floor(Math.log10(end))); // thousandths of the whole, or finer

  let time = 0, playing = false, last = null, asked = false;
  const update = (now) => {
    asked = false;
    if (playing) {
      time = (time + (now - (last ?? now)) * end / (1000 * mill.duration)) % end;
      last = now;
      slider.value = time;
      ask();
    }
    draw(time / end);
    clock.textContent = time.toFixed(decimals) + " ms";
    slider.setAttribute("aria-valuetext", clock.textContent);
  };
  /** Draws once before the next repaint. */
  const ask = () => {
    if (!asked) requestAnimationFrame(update);
    asked = true;
  };
  const setPlaying = (on) => {
    playing = on;
    last = null;
    button.textContent = on ? "Pause" : "Play";
    ask();
  };

  addControls(camera, canvas, mill.target, ask);
  button.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => {
    time = slider.valueAsNumber;
    ask();
  });
  new ResizeObserver(() => {
    camera.aspect = stage.clientWidth / stage.clientHeight;
    camera.updateProjectionMatrix();
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(stage.clientWidth, stage.clientHeight);
    ask();
  }).observe(stage);

  canvas.setAttribute("role", "application"); // it takes keys
  canvas.setAttribute("aria-label", "The vessel and its balls as they move; arrow keys turn it, + and - zoom");
  stage.append(canvas);
  document.getElementById("player").hidden = false;
  document.body.classList.add("plays"); // in place of the still picture
  setPlaying(!matchMedia("(prefers-reduced-motion: reduce)").matches);
}

let renderer = null;
try {
  renderer = new THREE.WebGLRenderer({ alpha: true, antialias: true });
} catch {
  // Without WebGL the still picture stays; three.js has told the console why.
}
if (renderer) play(renderer);
