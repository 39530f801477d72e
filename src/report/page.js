// Plays the mill: the frames of the page's JSON, on demand. Lengths in millimetres, times in milliseconds.
"use strict";

const mostFineBalls = 200; // more balls are drawn with fewer triangles each

/** The balls of one colour. Returns a function that puts them where they are between two frames. */
function addBalls(scene, spheres, places, colour) {
  const members = [...spheres.colours.keys()].filter((i) => spheres.colours[i] === colour);
  const count = spheres.radii.length;
  const sphere = count > mostFineBalls ? [12, 8] : [24, 16];
  const mesh = new THREE.InstancedMesh(
    new THREE.SphereBufferGeometry(1, ...sphere), new THREE.MeshLambertMaterial({ color: colour }), members.length);
  mesh.frustumCulled = false; // its bounds are those of one ball at the origin
  mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
  members.forEach((i, k) => {
    const r = spheres.radii[i];
    mesh.setMatrixAt(k, new THREE.Matrix4().makeScale(r, r, r));
  });
  scene.add(mesh);
  const matrices = mesh.instanceMatrix.array;
  return (frame, share) => {
    members.forEach((i, k) => {
      const from = 3 * (frame * count + i), to = from + 3 * count;
      for (let axis = 0; axis < 3; ++axis)
        matrices[16 * k + 12 + axis] = (1 - share) * places[from + axis] + share * places[to + axis];
    });
    mesh.instanceMatrix.needsUpdate = true;
  };
}

/** The vessel. Returns a function that puts it where it is between two frames. */
function addVessel(scene, vessel) {
  const mesh = new THREE.Mesh(
    new THREE.CylinderBufferGeometry(vessel.radius, vessel.radius, vessel.height, 48),
    new THREE.MeshLambertMaterial({
      color: vessel.colour, opacity: vessel.opacity, transparent: true, depthWrite: false, side: THREE.DoubleSide }));
  scene.add(mesh);
  const place = new THREE.Vector3(), turn = new THREE.Quaternion();
  return (frame, share) => {
    mesh.position.fromArray(vessel.poses, 7 * frame).lerp(place.fromArray(vessel.poses, 7 * (frame + 1)), share);
    mesh.quaternion.fromArray(vessel.poses, 7 * frame + 3).slerp(turn.fromArray(vessel.poses, 7 * (frame + 1) + 3), share);
  };
}

/** Who looks, with a lamp over the shoulder. */
function addCamera(scene, eye, target) {
  const camera = new THREE.PerspectiveCamera(THREE.Math.radToDeg(0.6)); // the swing just fills it
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

function play(renderer) {
  const mill = JSON.parse(document.getElementById("frames").textContent);
  const stage = document.querySelector(".stage"), canvas = renderer.domElement;
  const button = document.getElementById("play"), slider = document.getElementById("time");
  const clock = document.getElementById("clock");
  const end = Number(slider.max), frames = mill.vessel.poses.length / 7;
  const places = Float32Array.from(mill.spheres.places);

  const scene = new THREE.Scene();
  const camera = addCamera(scene, mill.eye, mill.target);
  const movers = [...new Set(mill.spheres.colours)].map((colour) => addBalls(scene, mill.spheres, places, colour));
  movers.push(addVessel(scene, mill.vessel)); // in front of the balls: it is transparent

  let time = 0, playing = false, last = null, asked = false;
  const draw = (now) => {
    asked = false;
    if (playing) {
      time = (time + (now - (last ?? now)) * end / (1000 * mill.duration)) % end;
      last = now;
      slider.value = time;
      ask();
    }
    const at = (time / end) * (frames - 1), frame = Math.min(Math.floor(at), frames - 2);
    for (const move of movers) move(frame, at - frame);
    clock.textContent = time.toFixed(1) + " ms";
    slider.setAttribute("aria-valuetext", clock.textContent);
    renderer.render(scene, camera);
  };
  /** Draws once before the next repaint. */
  const ask = () => {
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  };
  const setPlaying = (on) => {
    playing = on;
    last = null;
    button.textContent = on ? "Pause" : "Play";
    ask();
  };

  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false; // they scroll the page
  canvas.tabIndex = -1;
  controls.target.fromArray(mill.target);
  controls.update();
  controls.addEventListener("change", ask);
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

  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The vessel and its balls as they move");
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
