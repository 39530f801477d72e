"""What is asked of a report's page in the browser."""
# Labels of a drawing that are on top of each other or cut off, in the screen's pixels.
BAD_LABELS = """
    const shown = (svg) => svg.getBoundingClientRect().width > 0;
    const bad = [];
    for (const svg of [...document.querySelectorAll('main svg')].filter(shown)) {
      const frame = svg.getBoundingClientRect();
      const texts = [...svg.querySelectorAll('text')].map(t => ({text: t.textContent, box: t.getBoundingClientRect()}));
      for (const {text, box} of texts)
        if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 || box.bottom > frame.bottom + 1)
          bad.push(svg.closest('figure').id + ': ' + text + ' is cut off');
      texts.forEach((a, k) => texts.slice(k + 1).forEach(b => {
        const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const high = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
        if (wide > 1 && high > 3)  // a line of text has room above and below its letters
          bad.push(svg.closest('figure').id + ': ' + a.text + ' on ' + b.text);
      }));
    }
    return bad"""

# How far balls and corners of the vessel get from the middle of the canvas in any frame: 1 is its
# edge.
FARTHEST = """
    const mill = JSON.parse(document.getElementById('frames').textContent);
    const canvas = document.querySelector('.stage canvas'), high = Math.tan(0.3), wide = high * canvas.clientWidth / canvas.clientHeight;
    const rounds = (v, q) => {  // v turned by the quaternion
      const [x, y, z, w] = q, t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
      return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
    };
    let farthest = 0;
    const see = (p, radius) => {
      const depth = mill.eye[2] - p[2];
      const at = (k, scale) => (Math.abs(p[k] - mill.eye[k]) + radius) / (scale * depth);
      farthest = Math.max(farthest, depth > radius ? Math.max(at(0, wide), at(1, high)) : Infinity);
    };
    const {walls, poses} = mill.vessel, {radii, places} = mill.spheres, triple = (a, k) => a.slice(3 * k, 3 * k + 3);
    const points = walls.flatMap(wall => wall.points);
    for (let frame = 0; frame < poses.length / 7; ++frame) {
      const pose = poses.slice(7 * frame, 7 * frame + 7);
      radii.forEach((radius, k) => see(triple(places, frame * radii.length + k), radius));
      for (const point of points) see(rounds(point, pose.slice(3)).map((x, c) => x + pose[c]), 0);
    }
    return farthest"""
