// Plays the mill: the frames of the page's JSON, on demand. Lengths in millimetres, times in
// milliseconds.
"use strict";

/** Values of a list between two of its frames. */
function framesAt(list, size, fraction) {
  const steps = list.length / size - 1, frame = Math.min(Math.floor(fraction * steps), steps - 1), share = fraction * steps - frame;
  return (first, count) => Array.from({ length: count }, (_, k) => (1 - share) * list[size * frame + first + k] + share * list[size * (frame + 1) + first + k]);
}

/** The pose of the vessel or of a body at a fraction of the playback. */
function poseAt(poses, fraction) {
  const steps = poses.length / 7 - 1, frame = Math.min(Math.floor(fraction * steps), steps - 1), share = fraction * steps - frame;
  // Turns of two frames are near each other, but the numbers of one turn may have either sign.
  const turns = [0, 1].map((k) => poses.slice(7 * (frame + k) + 3, 7 * (frame + k) + 7));
  const sign = turns[0].reduce((sum, part, k) => sum + part * turns[1][k], 0) < 0 ? -1 : 1;
  const mixed = turns[0].map((part, k) => (1 - share) * part + sign * share * turns[1][k]), length = Math.hypot(...mixed);
  const [x, y, z, w] = mixed.map((part) => part / length), origin = framesAt(poses, 7, fraction)(0, 3);
  const turned = (p, w) => {
    const t = [2 * (y * p[2] - z * p[1]), 2 * (z * p[0] - x * p[2]), 2 * (x * p[1] - y * p[0])];
    const twice = [y * t[2] - z * t[1], z * t[0] - x * t[2], x * t[1] - y * t[0]];
    return p.map((c, k) => c + w * t[k] + twice[k]);
  };
  return { outside: (p) => turned(p, w).map((c, k) => origin[k] + c), inside: (p) => turned(p.map((c, k) => c - origin[k]), -w) };
}

/** What the mill shows at a fraction of its playback, between two of its frames; with the jar at rest for one who `rides` with it. */
function stateAt({ vessel, bodies, spheres }, fraction, rides) {
  const pose = poseAt(vessel.poses, fraction), seen = (p) => rides ? pose.inside(p) : p;
  const walls = vessel.walls.map(({ points, flat, shifts }) => {
    const shift = shifts ? framesAt(shifts, 3, fraction)(0, 3) : [0, 0, 0];
    const moved = points.map((p) => p.map((c, k) => c + shift[k]));
    return { flat, points: rides ? moved : moved.map(pose.outside) };
  });
  const solids = bodies.map(({ points, colour, poses }) => ({ colour, points: points.map(poseAt(poses, fraction).outside).map(seen) }));
  const places = framesAt(spheres.places, 3 * spheres.radii.length, fraction)(0, 3 * spheres.radii.length);
  return { walls, solids, balls: spheres.radii.map((radius, k) => ({ radius, colour: spheres.colours[k], place: seen(places.slice(3 * k, 3 * k + 3)) })) };
}

function play() {
  const mill = JSON.parse(document.getElementById("frames").textContent);
  const stage = document.querySelector(".stage"), canvas = document.createElement("canvas"), button = document.getElementById("play"), slider = document.getElementById("time");
  const clock = document.getElementById("clock"), end = Number(slider.max);
  const decimals = Math.max(0, 3 - Math.floor(Math.log10(end))); // thousandths of the whole, or finer
  const ride = document.getElementById("ride"), view = new MillView(canvas, mill.target, mill.eye[2] - mill.target[2]);
  const path = Array.from({ length: mill.vessel.poses.length / 7 }, (_, k) => mill.vessel.poses.slice(7 * k, 7 * k + 3));
  const extent = (k) => Math.max(...path.map((p) => p[k])) - Math.min(...path.map((p) => p[k]));
  if (extent(2) > 3 * extent(1)) { // the jar's way is a circle, seen from the side
    view.turn(0, 0.5);
    view.fit(Array.from({ length: 24 }, (_, k) => stateAt(mill, k / 24, false).walls.flatMap((wall) => wall.points)).flat());
  }
  const look = { colour: mill.vessel.colour, opacity: mill.vessel.opacity / 2, edge: "#b59a00b0" };

  let time = 0, playing = false, last = null, asked = false;
  const update = (now) => {
    asked = false;
    if (playing) {
      time = (time + (now - (last ?? now)) * end / (1000 * mill.duration)) % end;
      last = now;
      slider.value = time;
      ask();
    }
    const { walls, solids, balls } = stateAt(mill, time / end, ride.checked);
    view.draw(walls, balls, look, ride.checked ? [] : path, solids);
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

  /** From outside, or riding with the jar, which then fills the picture. */
  const choose = () => {
    const points = mill.vessel.walls.flatMap((wall) => wall.points), [low, high] = [Math.min, Math.max].map((f) => [0, 1, 2].map((k) => f(...points.map((p) => p[k]))));
    view.target = ride.checked ? low.map((c, k) => (c + high[k]) / 2) : mill.target;
    view.distance = ride.checked ? 1.9 * Math.hypot(...high.map((c, k) => c - low[k])) : mill.eye[2] - mill.target[2];
    ask();
  };

  ride.addEventListener("change", choose);
  view.listen(ask);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.distance *= event.deltaY > 0 ? 1.1 : 1 / 1.1;
    ask();
  });
  button.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => {
    time = slider.valueAsNumber;
    ask();
  });
  new ResizeObserver(() => {
    canvas.width = devicePixelRatio * stage.clientWidth;
    canvas.height = devicePixelRatio * stage.clientHeight;
    ask();
  }).observe(stage);

  canvas.tabIndex = 0;
  canvas.setAttribute("role", "application"); // it takes keys
  canvas.setAttribute("aria-label", "The vessel and its balls as they move; arrow keys turn it, + and - zoom");
  stage.append(canvas);
  setPlaying(!matchMedia("(prefers-reduced-motion: reduce)").matches);
}

play();
