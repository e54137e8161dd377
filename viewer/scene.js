/// The drawing: one WebGL context, views side by side, with one camera.

/* global THREE */
/// Arrows along warp on both sides of a cloth, of that length. An item of `warp` has the corners of a triangle, and
/// warp by its edges.
function arrows(x, warp, length) {
  const outline = [[-.5, 0], [.5, 0], [.2, .15], [.5, 0], [.2, -.15], [.5, 0]];  // shaft and barbs, along and across warp
  return new THREE.BufferGeometry().setFromPoints(warp.flatMap(([i, j, k, a, b]) => {
    const [p, q, r] = [i, j, k].map(v => new THREE.Vector3().fromArray(x, 3 * v)), centre = p.clone().add(q).add(r).divideScalar(3);
    const e1 = q.sub(p), e2 = r.sub(p), normal = e1.clone().cross(e2).normalize();
    const along = e1.multiplyScalar(a).addScaledVector(e2, b).normalize(), across = normal.clone().cross(along);
    return [1, -1].flatMap(side => outline.map(([u, v]) => centre.clone().addScaledVector(along, u * length)
      .addScaledVector(across, v * length).addScaledVector(normal, .04 * side * length)));
  }));
}

/// The ground below a view: nothing but the shadow that `map` holds, as it is seen from above, with soft borders.
function ground() {
  const material = new THREE.ShaderMaterial({transparent: true, depthWrite: false, uniforms: {map: {value: null}},
    vertexShader: 'varying vec2 place; void main() { place = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
    fragmentShader: `
      uniform sampler2D map;
      varying vec2 place;
      void main() {
        float dark = 0.0;
        for (int i = -4; i <= 4; ++i)
          for (int j = -4; j <= 4; ++j) dark += texture2D(map, place + 0.008 * vec2(float(i), float(j))).r;
        gl_FragColor = vec4(0.0, 0.0, 0.0, 0.3 * dark / 81.0);
      }`});
  return new THREE.Mesh(new THREE.PlaneGeometry(1, 1), material);
}

export class Scene {
  /// Throws without WebGL.
  constructor(canvas, labels) {
    const context = ['webgl2', 'webgl'].reduce((gl, kind) => gl || canvas.getContext(kind, {antialias: false}), null);
    if (!context) throw new Error('no WebGL');
    Object.assign(this, {canvas, labels, views: [], waiting: false});
    this.renderer = new THREE.WebGLRenderer({canvas, context});
    this.renderer.setScissorTest(true);
    this.camera = new THREE.PerspectiveCamera(28, 1, .01, 100);
    this.camera.up.set(0, 0, 1);
    const front = [.83, .76, .66], back = [.62, .7, .77], grey = [.45, .47, .5];
    // Seams are drawn in front of the cloth that they are in; a factor of the slope would show its back along folds.
    this.cloth = Scene.material(false, front, back, {polygonOffsetFactor: 0, polygonOffsetUnits: 60});
    this.painted = Scene.material(true, front, back, {polygonOffsetFactor: 0, polygonOffsetUnits: 60});
    // What lies on an obstacle is drawn in front of it, without speckles.
    this.solid = Scene.material(false, grey, grey, {polygonOffsetFactor: 1, polygonOffsetUnits: 61});
    this.shade = new THREE.MeshBasicMaterial({color: 0xffffff, side: THREE.DoubleSide});
    this.sun = new THREE.OrthographicCamera();
    this.warp = new THREE.LineBasicMaterial({color: 0xb3261e, visible: false});
    this.seams = new THREE.LineBasicMaterial({color: 0x3a2d22});
    this.lookAt([0, 0, 0], 1);
    new ResizeObserver(() => this.layOut()).observe(canvas.parentElement);
    canvas.addEventListener('webglcontextrestored', () => this.draw());
    this.listen();
  }

  /// Light comes from above the viewer's left shoulder: both sides of the cloth are lit from every direction.
  static material(painted, front, back, offset) {
    return new THREE.ShaderMaterial({
      side: THREE.DoubleSide, polygonOffset: true, ...offset,
      uniforms: {painted: {value: painted ? 1 : 0}, square: {value: 0}, opacity: {value: 1}, front: {value: new THREE.Vector3(...front)}, back: {value: new THREE.Vector3(...back)}},
      vertexShader: `
        attribute vec3 tint, rest;
        varying vec3 eyeNormal, eyePosition, colour;
        varying vec2 place;
        void main() {
          vec4 p = modelViewMatrix * vec4(position, 1.0);
          eyePosition = p.xyz;
          eyeNormal = mat3(viewMatrix) * normal;
          colour = tint;
          place = rest.xz;
          gl_Position = projectionMatrix * p;
        }`,
      fragmentShader: `
        uniform vec3 front, back;
        uniform float painted, opacity, square;
        varying vec3 eyeNormal, eyePosition, colour;
        varying vec2 place;
        void main() {
          float side = gl_FrontFacing ? 1.0 : -1.0;
          vec3 n = normalize(eyeNormal + vec3(0.0, 0.0, 1e-9)) * side;
          vec3 up = mat3(viewMatrix) * vec3(0.0, 0.0, 1.0);
          vec3 key = normalize(vec3(-0.75, 0.25, 0.25) + 0.62 * up), fill = normalize(vec3(0.8, 0.1, 0.5));
          vec3 base = mix(gl_FrontFacing ? front : back, colour * (gl_FrontFacing ? 1.0 : 0.94), painted);
          if (square > 0.0 && mod(floor(place.x / square) + floor(place.y / square), 2.0) > 0.5) base *= 0.7;
          float lambert = dot(n, key), direct = max(0.0, (lambert + 0.2) / 1.2);
          float open = 0.5 + 0.5 * dot(n, up);
          vec3 light = vec3(0.98, 0.92, 0.82) * direct * direct + vec3(0.12, 0.14, 0.18) * max(dot(n, fill), 0.0)
                     + vec3(0.34, 0.38, 0.44) * (0.5 + 0.6 * open);
          light = mix(light, vec3(0.95), 0.5 * painted);
          float edge = 1.0 - max(dot(n, normalize(-eyePosition)), 0.0), sheen = edge * edge * edge * edge;
          gl_FragColor = vec4(sqrt(min(base * base * light + vec3(0.07) * sheen, vec3(1.0))), opacity);  // with a gamma of 2
        }`,
    });
  }

  /// X-ray: everything lets through what is behind it.
  setXray(on) {
    for (const material of [this.cloth, this.painted, this.solid]) {
      material.uniforms.opacity.value = on ? .45 : 1;
      material.transparent = on;
      material.depthWrite = !on;
    }
    this.draw();
  }
  /// Whether obstacles stand back by some per cent of the scene: a smooth surface lies within its mesh, which rests on them.
  setBack(on) { this.solid.polygonOffsetUnits = on ? 3000 : 61; }
  /// Darkens every other square of this side [m] in the rest shape; 0 for none.
  setSquares(side) {
    for (const material of [this.cloth, this.painted]) material.uniforms.square.value = side;
  }
  /// Shows `warp`, as arrows, or `seams`, as lines.
  setLines(kind, on) {
    this[kind].visible = on;
    this.draw();
  }

  /// Sets the number of views.
  setViews(count) {
    while (this.views.length < count) this.views.push({scene: new THREE.Scene(), mesh: null, obstacles: [], ground: ground(), shadow: new THREE.WebGLRenderTarget(256, 256)});
    for (const {shadow} of this.views.splice(count)) shadow.dispose();
    this.layOut();
  }
  /// Shows obstacles in a view.
  setObstacles(k, shapes) {
    const view = this.views[k];
    if (view.obstacles.length === shapes.length && shapes.every(({x}, i) => view.obstacles[i].userData.x === x)) return;
    view.obstacles.forEach(mesh => this.remove(view, mesh));
    view.obstacles = shapes.map(shape => this.add(view, shape, this.solid));
  }

  add(view, {x, index}, material) {
    const geometry = new THREE.BufferGeometry(), mesh = new THREE.Mesh(geometry, material);
    geometry.setIndex(index);
    geometry.setAttribute('position', new THREE.BufferAttribute(x, 3));
    geometry.computeVertexNormals();
    geometry.computeBoundingSphere();
    mesh.userData.x = x;
    view.scene.add(mesh);
    return mesh;
  }
  remove(view, mesh) {
    view.scene.remove(mesh);
    mesh.children.forEach(lines => lines.geometry.dispose());
    mesh.geometry.setIndex(null);  // the index is the document's, and stays
    mesh.geometry.dispose();
  }

  /// Shows a state in a view; null empties it. `tints` is three bytes per vertex, or null for plain cloth; `rest` the place of each
  /// vertex at rest, for squares.
  setCloth(k, shape) {
    const view = this.views[k];
    if (view.mesh && (!shape || view.mesh.userData.x !== shape.x)) {
      this.remove(view, view.mesh);
      view.mesh = null;
    }
    if (!shape) return;
    if (!view.mesh) {
      view.mesh = this.add(view, shape, this.cloth);
      view.flat = shape.flat && view.mesh.geometry.boundingSphere;
      if (shape.seams) {
        const lines = new THREE.BufferGeometry();
        lines.setAttribute('position', view.mesh.geometry.attributes.position);
        lines.setIndex(shape.seams);  // which returns nothing in older versions of three.js
        view.mesh.add(new THREE.LineSegments(lines, this.seams));
      }
      if (shape.warp) view.mesh.add(new THREE.LineSegments(arrows(shape.x, shape.warp, .06 * this.home.cloth), this.warp));
    }
    if (shape.tints) view.mesh.geometry.setAttribute('tint', new THREE.BufferAttribute(shape.tints, 3, true));
    if (shape.rest) view.mesh.geometry.setAttribute('rest', new THREE.BufferAttribute(shape.rest, 3));
    view.mesh.material = shape.tints ? this.painted : this.cloth;
  }

  /// Three quarters from above, as the pictures, at a distance where a ball of that radius fills the view. `cloth`: the radius of one
  /// around the cloth.
  lookAt(centre, radius, cloth = radius) {
    this.home = {target: centre.slice(), radius, cloth};
    this.resetView();
  }
  resetView() {
    this.view = {target: this.home.target.slice(), azimuth: Math.atan2(-1, .55), elevation: Math.atan2(.68, Math.hypot(.55, 1)),
      distance: this.home.radius / Math.sin(14 * Math.PI / 180) * .98};
    this.draw();
  }
  turn(right, up) {
    this.view.azimuth -= right;
    this.view.elevation = Math.min(Math.max(this.view.elevation + up, -1.5), 1.5);
    this.draw();
  }
  zoom(factor) {
    const r = this.home.radius;
    this.view.distance = Math.min(Math.max(this.view.distance * factor, .05 * r), 40 * r);
    this.draw();
  }
  /// In units of a view's height.
  move(right, up) {
    const {azimuth: a, elevation: e, distance} = this.view, size = 2 * distance * Math.tan(14 * Math.PI / 180);
    const across = [-Math.sin(a), Math.cos(a), 0], upward = [-Math.cos(a) * Math.sin(e), -Math.sin(a) * Math.sin(e), Math.cos(e)];
    for (let k = 0; k < 3; ++k) this.view.target[k] -= size * (right * across[k] + up * upward[k]);
    this.draw();
  }

  /// One pointer turns, or pans with Shift or another button; two pan and zoom.
  listen() {
    const {canvas} = this, down = new Map();
    const middle = () => [...down.values()].reduce((m, p) => [m[0] + p[0] / down.size, m[1] + p[1] / down.size], [0, 0]);
    const apart = () => { const [a, b] = [...down.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    canvas.addEventListener('pointerdown', event => {
      canvas.setPointerCapture(event.pointerId);
      down.set(event.pointerId, [event.clientX, event.clientY]);
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, event => down.delete(event.pointerId));
    canvas.addEventListener('pointermove', event => {
      if (!down.has(event.pointerId)) return;
      const before = middle(), distance = down.size === 2 && apart();
      down.set(event.pointerId, [event.clientX, event.clientY]);
      const after = middle(), right = after[0] - before[0], up = before[1] - after[1], height = this.panel.height;
      if (down.size > 1 || event.shiftKey || event.buttons > 1) this.move(right / height, up / height);
      else this.turn(right * 3 / height, -up * 3 / height);
      if (distance) this.zoom(distance / Math.max(apart(), 1));
    });
  }

  layOut() {
    const width = this.canvas.parentElement.clientWidth, count = Math.max(this.views.length, 1);
    if (!width) return;
    this.columns = Math.max(1, Math.min(count, Math.floor(width / (count > 2 ? 220 : 150))));
    this.rows = Math.ceil(count / this.columns);
    this.panel = {width: width / this.columns};
    this.panel.height = Math.round(Math.min(this.panel.width * (this.columns > 1 ? 1.25 : .72), (this.rows > 1 ? .4 : .66) * innerHeight));
    this.renderer.setSize(width, this.panel.height * this.rows, false);
    this.canvas.style.height = this.panel.height * this.rows + 'px';
    this.labels.style.gridTemplate = `repeat(${this.rows}, ${this.panel.height}px) / repeat(${this.columns}, 1fr)`;
    this.draw();
  }

  /// Lays the ground below what a view has near its cloth, with the shadow of light from above, if that has changed.
  cast(view) {
    const meshes = view.flat ? [] : [view.mesh, ...view.obstacles].filter(mesh => mesh), shapes = meshes.map(mesh => mesh.userData.x), {target: [x, y, z], radius: r} = this.home;
    if (view.cast?.length === shapes.length && shapes.every((shape, k) => shape === view.cast[k])) return;
    view.cast = shapes;
    let floor = Infinity;
    for (const shape of shapes)
      for (let i = 0; i < shape.length; i += 3)
        if (Math.hypot(shape[i] - x, shape[i + 1] - y, shape[i + 2] - z) < 1.5 * r) floor = Math.min(floor, shape[i + 2]);
    view.scene.remove(view.ground);
    if (!isFinite(floor)) return;
    Object.assign(this.sun, {left: -2 * r, right: 2 * r, top: 2 * r, bottom: -2 * r, near: 0, far: 20 * r});
    this.sun.position.set(x, y, floor + 10 * r);
    this.sun.updateProjectionMatrix();
    view.scene.overrideMaterial = this.shade;
    this.renderer.setRenderTarget(view.shadow);
    this.renderer.setClearColor(0);
    this.renderer.clear();
    this.renderer.render(view.scene, this.sun);
    this.renderer.setRenderTarget(null);
    view.scene.overrideMaterial = null;
    view.ground.material.uniforms.map.value = view.shadow.texture;
    view.ground.scale.set(4 * r, 4 * r, 1);
    view.ground.position.set(x, y, floor - .002 * r);
    view.scene.add(view.ground);
  }

  /// The picture as a PNG file.
  async picture() {
    this.render(2);
    return new Promise(resolve => this.canvas.toBlob(resolve));
  }

  /// Once per frame, however often it is requested; what rests, with smooth edges. Multisampling would smooth them too, but costs
  /// more, and where the processor draws it leaves dots along folds.
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    clearTimeout(this.resting);
    requestAnimationFrame(() => {
      this.waiting = false;
      if (!this.panel) return;
      this.render(Math.min(devicePixelRatio || 1, 2));
      this.resting = setTimeout(() => this.render(2), 150);
    });
  }
  /// In `ratio`² pixels for each of the page's.
  render(ratio) {
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
    const camera = this.camera;
    camera.aspect = this.panel.width / this.panel.height;
    this.views.forEach(view => this.cast(view));
    this.renderer.setClearColor(getComputedStyle(this.canvas.parentElement).backgroundColor);
    const drawIn = (...place) => {
      this.renderer.setScissor(...place);
      this.renderer.setViewport(...place);
    };
    drawIn(0, 0, this.panel.width * this.columns, this.panel.height * this.rows);
    this.renderer.clear();
    this.views.forEach((view, k) => {
      const row = this.rows - 1 - Math.floor(k / this.columns);
      drawIn(k % this.columns * this.panel.width, row * this.panel.height, this.panel.width, this.panel.height);
      this.aim(view.flat);
      this.renderer.render(view.scene, camera);
    });
  }
  /// Points the camera; at flat pieces, within a sphere, from the front, moved and zoomed alike.
  aim(flat) {
    let {target, azimuth, elevation, distance} = this.view, r = this.home.radius;
    distance *= Math.max(1, this.panel.height / this.panel.width);  // the whole fits a narrow panel too
    if (flat) {
      const s = flat.radius / r, [x, y, z] = target.map((v, k) => s * (v - this.home.target[k]));
      const right = y * Math.cos(azimuth) - x * Math.sin(azimuth), up = z * Math.cos(elevation) - (x * Math.cos(azimuth) + y * Math.sin(azimuth)) * Math.sin(elevation);
      target = [flat.center.x + right, flat.center.y, flat.center.z + up];
      [azimuth, elevation, distance, r] = [-Math.PI / 2, 0, s * distance, flat.radius];
    }
    const camera = this.camera;
    camera.position.set(target[0] + distance * Math.cos(elevation) * Math.cos(azimuth),
      target[1] + distance * Math.cos(elevation) * Math.sin(azimuth), target[2] + distance * Math.sin(elevation));
    camera.lookAt(...target);
    camera.near = Math.max(distance - 8 * r, distance / 40);  // nearer ends would leave too few depths between layers of cloth
    camera.far = distance + 12 * r;
    camera.updateProjectionMatrix();
  }
}
