// A mill on a canvas: balls lit from above, and the outline of the vessel, which is convex, with
// the edges of its flat walls.
"use strict";

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The corners of the convex hull of points in a plane. */
function hull(points) {
  const right = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0;
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list) => list.reduce((chain, p) => {
    while (chain.length > 1 && right(chain[chain.length - 2], chain[chain.length - 1], p)) chain.pop();
    chain.push(p);
    return chain;
  }, []).slice(0, -1);
  return [...half(sorted), ...half(sorted.reverse())];
}

class MillView {
  /** The eye is `distance` from the target; without angles it looks along -z, y upwards. */
  constructor(canvas, target, distance, azimuth = 0, elevation = 0) {
    Object.assign(this, { canvas, target, distance, azimuth, elevation, sprites: {} });
  }
  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.max(-1.5, Math.min(1.5, this.elevation + elevation));
  }
  /** Moves the target and the eye so that the places fill a picture of 4 by 3. */
  fit(places) {
    const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    const along = (axis) => places.map((place) => dot(place.map((c, k) => c - this.target[k]), axis));
    const axes = [[ca, 0, -sa], [-sa * se, ce, -ca * se]];
    const middle = (values) => (Math.max(...values) + Math.min(...values)) / 2;
    for (let round = 0; round < 4; ++round) { // what is nearer looks larger
      const [x, y, depth] = [...axes, [sa * ce, se, ca * ce]].map(along);
      this.distance = Math.max(...depth.map((z, k) => z + 1.05 * Math.max(Math.abs(x[k]) * 3 / 4, Math.abs(y[k])) / Math.tan(0.3)));
      const shifts = [x, y].map((values) => this.distance * middle(values.map((value, k) => value / (this.distance - depth[k]))));
      if (round < 3) this.target = this.target.map((c, k) => c + axes[0][k] * shifts[0] + axes[1][k] * shifts[1]);
    }
  }
  /** Turns it with the pointer and the arrow keys; + and - change the distance. */
  listen(onChange) {
    const keys = { ArrowLeft: [-0.1, 0, 1], ArrowRight: [0.1, 0, 1], ArrowUp: [0, 0.1, 1], ArrowDown: [0, -0.1, 1], "+": [0, 0, 0.9], "-": [0, 0, 1 / 0.9] };
    this.canvas.addEventListener("keydown", (event) => {
      const step = keys[event.key];
      if (!step) return;
      event.preventDefault(); // the page stays where it is
      this.turn(step[0], step[1]);
      this.distance *= step[2];
      onChange();
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!(event.buttons & 1)) return;
      this.turn(-event.movementX / 100, event.movementY / 100);
      onChange();
    });
  }
  /** Where a place is in the picture, and how many pixels one of its units has there. */
  seen(place) {
    const [ca, sa, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    const off = [0, 1, 2].map((k) => place[k] - this.target[k]);
    const { width, height } = this.canvas;
    const scale = height / 2 / Math.tan(0.3) / (this.distance - dot(off, [sa * ce, se, ca * ce]));
    return [width / 2 + scale * dot(off, [ca, 0, -sa]), height / 2 - scale * dot(off, [-sa * se, ce, -ca * se]), scale];
  }
  /** A picture of a sphere. */
  sprite(colour) {
    if (this.sprites[colour]) return this.sprites[colour];
    const size = 128, canvas = document.createElement("canvas"), context = canvas.getContext("2d");
    canvas.width = canvas.height = size;
    const light = context.createRadialGradient(0.36 * size, 0.3 * size, 0, size / 2, size / 2, size / 2);
    for (const [place, shade] of [[0, "#ffffff70"], [0.5, "#ffffff00"], [1, "#00000060"]]) light.addColorStop(place, shade);
    context.arc(size / 2, size / 2, size / 2, 0, 2 * Math.PI);
    for (const style of [colour, light]) {
      context.fillStyle = style;
      context.fill();
    }
    return this.sprites[colour] = canvas;
  }
  /** @param walls  [{points, flat}] @param balls  [{place, radius, colour}] @param path  of the vessel's centre; may be empty
   *  @param solids  convex bodies, [{points, colour}] */
  draw(walls, balls, { colour, opacity, edge }, path = [], solids = []) {
    const context = this.canvas.getContext("2d");
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    const shapes = walls.map(({ points, flat }) => ({ flat, corners: points.map((p) => this.seen(p)) }));
    const outline = hull(shapes.flatMap(({ corners }) => corners));
    const trace = (corners) => {
      context.beginPath();
      for (const [x, y] of corners) context.lineTo(x, y);
      context.closePath();
    };
    context.globalAlpha = opacity;
    context.fillStyle = colour;
    trace(outline);
    context.fill();
    context.globalAlpha = 1;
    const seen = balls.map(({ place, radius, colour }) => ({ at: this.seen(place), radius, colour }));
    for (const { points, colour } of solids) {
      const centre = [0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);
      seen.push({ at: this.seen(centre), corners: hull(points.map((p) => this.seen(p))), colour });
    }
    seen.sort((a, b) => a.at[2] - b.at[2]); // the nearest last
    context.strokeStyle = edge;
    for (const { at: [x, y, scale], radius, corners, colour } of seen) {
      if (corners) {
        context.fillStyle = colour;
        trace(corners);
        context.fill();
        context.stroke();
        continue;
      }
      const r = scale * radius;
      context.drawImage(this.sprite(colour), x - r, y - r, 2 * r, 2 * r);
    }
    for (const corners of [outline, ...shapes.filter(({ flat }) => flat).map(({ corners }) => corners)]) {
      trace(corners);
      context.stroke();
    }
    this.mark(shapes[0], edge);
    context.beginPath();
    context.setLineDash([4, 4]);
    for (const place of path) context.lineTo(...this.seen(place).slice(0, 2));
    context.stroke();
    context.setLineDash([]);
  }
  /** A mark on the vessel's first wall, by which its turning is seen. */
  mark(wall, colour) {
    if (!wall) return;
    const { flat, corners } = wall, end = corners[flat ? 0 : corners.length >> 1];
    const middle = [0, 1].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) / corners.length);
    const context = this.canvas.getContext("2d");
    context.strokeStyle = context.fillStyle = colour;
    context.beginPath();
    if (flat) context.moveTo(...middle);
    else context.arc(end[0], end[1], 3, 0, 2 * Math.PI);
    context.lineTo(end[0], end[1]);
    context.lineWidth = 3;
    context.stroke();
    context.lineWidth = 1;
  }
}
