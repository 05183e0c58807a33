"use strict";
// Replays of recorded moments in 3D. A page of reports has to stay small, so this draws with WebGL alone: the shapes of
// docs/schemas/trace.schema.json, an orbiting camera, one clock for all views of a replay.
(() => {
  const { scenes, moments } = JSON.parse(document.getElementById("moments").textContent);
  const SEGMENTS = 24;
  const ENDLESS = 4; // half edge of an endless plane, m
  const LIT = `#version 300 es
    in vec3 place; in vec3 normal; uniform mat4 model; uniform mat4 view; out vec3 facing;
    void main() { facing = mat3(model) * normal; gl_Position = view * model * vec4(place, 1.0); }`;
  const PAINTED = `#version 300 es
    precision mediump float; in vec3 facing; uniform vec4 color; uniform bool lit; out vec4 painted;
    void main() {
      vec3 n = normalize(facing + vec3(1e-6));
      float sun = max(dot(n, normalize(vec3(1.5, -2.0, 4.0))), 0.0) * 0.5 + max(dot(n, normalize(vec3(-2.0, 1.5, 1.0))), 0.0) * 0.15;
      painted = vec4(color.rgb * (lit ? 0.45 + sun : 1.0), color.a);
    }`;

  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
  const floats = ({ data }) => new Float32Array(bytes(data));

  // Triangles as x, y, z of a corner and of its normal, in turn.
  function corner(out, place, normal) {
    out.push(...place, ...normal);
  }
  function lathe(profile) {
    const out = [];
    for (let index = 0; index + 1 < profile.length; index += 1) {
      for (let step = 0; step < SEGMENTS; step += 1) {
        const [from, to] = [step, step + 1].map((one) => (2 * Math.PI * one) / SEGMENTS);
        const at = ([r, z, nr, nz], angle) => [
          [r * Math.cos(angle), r * Math.sin(angle), z],
          [nr * Math.cos(angle), nr * Math.sin(angle), nz],
        ];
        const [low, high] = [profile[index], profile[index + 1]];
        for (const [point, angle] of [[low, from], [low, to], [high, to], [low, from], [high, to], [high, from]]) {
          corner(out, ...at(point, angle));
        }
      }
    }
    return out;
  }
  function arc(radius, from, to, lift) {
    const steps = 8;
    return Array.from({ length: steps + 1 }, (_, step) => {
      const angle = from + ((to - from) * step) / steps;
      return [radius * Math.cos(angle), radius * Math.sin(angle) + lift, Math.cos(angle), Math.sin(angle)];
    });
  }
  const RIGHT = Math.PI / 2;
  const capsule = (radius, half) => lathe([...arc(radius, -RIGHT, 0, -half), ...arc(radius, 0, RIGHT, half)]);
  const cylinder = (radius, half) =>
    lathe([[0, -half, 0, -1], [radius, -half, 0, -1], [radius, -half, 1, 0], [radius, half, 1, 0], [radius, half, 0, 1], [0, half, 0, 1]]);
  function ellipsoid(...size) {
    return capsule(1, 0).map((value, index) => (index % 6 < 3 ? value * size[index % 3] : value / size[index % 3]));
  }
  function box(...half) {
    const out = [];
    for (let axis = 0; axis < 3; axis += 1) {
      for (const side of [-1, 1]) {
        for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]]) {
          const [place, normal] = [[0, 0, 0], [0, 0, 0]];
          place[axis] = side * half[axis];
          place[(axis + 1) % 3] = u * half[(axis + 1) % 3];
          place[(axis + 2) % 3] = v * half[(axis + 2) % 3];
          normal[axis] = side;
          corner(out, place, normal);
        }
      }
    }
    return out;
  }
  function edges(center, half) {
    const out = [];
    for (let axis = 0; axis < 3; axis += 1) {
      for (const [u, v] of [[-1, -1], [-1, 1], [1, -1], [1, 1]]) {
        for (const side of [-1, 1]) {
          const place = [...center];
          place[axis] += side * half[axis];
          place[(axis + 1) % 3] += u * half[(axis + 1) % 3];
          place[(axis + 2) % 3] += v * half[(axis + 2) % 3];
          corner(out, place, [0, 0, 0]);
        }
      }
    }
    return out;
  }
  function meshed({ vertices, faces }) {
    const [points, corners, out] = [floats(vertices), new Uint32Array(bytes(faces.data)), []];
    for (let index = 0; index < corners.length; index += 3) {
      const [a, b, c] = [0, 1, 2].map((one) => [...points.subarray(3 * corners[index + one], 3 * corners[index + one] + 3)]);
      const [s, t] = [b, c].map((one) => one.map((value, axis) => value - a[axis]));
      const normal = [s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]];
      const size = Math.hypot(...normal) || 1;
      for (const place of [a, b, c]) {
        corner(out, place, normal.map((value) => value / size));
      }
    }
    return out;
  }
  function triangles({ kind, size: [a, b, c], mesh }, meshes) {
    switch (kind) {
      case "box":
        return box(a, b, c);
      case "sphere":
        return capsule(a, 0);
      case "ellipsoid":
        return ellipsoid(a, b, c);
      case "cylinder":
        return cylinder(a, b);
      case "capsule":
        return capsule(a, b);
      case "plane":
        return box(a || ENDLESS, b || ENDLESS, 1e-4);
      default:
        return meshed(meshes[mesh]);
    }
  }

  // Matrices of WebGL: 16 numbers, column by column.
  function pose([x, y, z, w, i, j, k]) {
    return [
      1 - 2 * (j * j + k * k), 2 * (i * j + k * w), 2 * (i * k - j * w), 0,
      2 * (i * j - k * w), 1 - 2 * (i * i + k * k), 2 * (j * k + i * w), 0,
      2 * (i * k + j * w), 2 * (j * k - i * w), 1 - 2 * (i * i + j * j), 0,
      x, y, z, 1,
    ];
  }
  function product(left, right) {
    return Array.from({ length: 16 }, (_, index) => {
      const [row, column] = [index % 4, index - (index % 4)];
      return [0, 1, 2, 3].reduce((sum, one) => sum + left[row + 4 * one] * right[column + one], 0);
    });
  }
  function normalized(vector) {
    const size = Math.hypot(...vector) || 1;
    return vector.map((value) => value / size);
  }
  const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
  const dot = (left, right) => left.reduce((sum, value, axis) => sum + value * right[axis], 0);
  function camera({ yaw, pitch, distance, target }, aspect) {
    const away = [Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch)];
    const eye = target.map((value, axis) => value + distance * away[axis]);
    const side = normalized(cross([0, 0, 1], away));
    const up = cross(away, side);
    const place = [side[0], up[0], away[0], 0, side[1], up[1], away[1], 0, side[2], up[2], away[2], 0, -dot(side, eye), -dot(up, eye), -dot(away, eye), 1];
    const [near, far, zoom] = [0.02, 60, 1 / Math.tan(0.35)];
    const lens = [zoom / aspect, 0, 0, 0, 0, zoom, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
    return product(lens, place);
  }

  /** A moment in a canvas of its own. `seek` shows an instant (s). */
  class View {
    constructor(moment, canvas) {
      this.moment = moment;
      this.canvas = canvas;
      this.gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
      if (this.gl === null) {
        throw new Error("no WebGL");
      }
      this.times = floats(moment.times);
      this.poses = floats(moment.poses);
      this.bodies = moment.bodies.map(({ position, orientation }) => [...position, ...orientation]);
      this.time = moment.at;
      this.eye = { yaw: -0.9, pitch: 0.45, ...this.extent() };
      this.prepare(scenes[moment.scene]);
      this.steer();
    }
    /** The centre of the bodies, and a distance from which all are seen. The floor is left out. */
    extent() {
      const shapes = scenes[this.moment.scene].shapes.filter(({ kind }) => kind !== "plane");
      const points = shapes.map(({ body }) => this.bodies[body].slice(0, 3));
      const [low, high] = [Math.min, Math.max].map((least) => [0, 1, 2].map((axis) => least(...points.map((point) => point[axis]))));
      if (points.length === 0) {
        return { target: [0, 0, 0], distance: 2 };
      }
      const target = low.map((value, axis) => (value + high[axis]) / 2);
      return { target, distance: Math.max(0.6, 1.1 * Math.hypot(...low.map((value, axis) => high[axis] - value))) };
    }
    prepare({ shapes, meshes, workspaces }) {
      const gl = this.gl;
      const program = gl.createProgram();
      for (const [kind, text] of [[gl.VERTEX_SHADER, LIT], [gl.FRAGMENT_SHADER, PAINTED]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
      }
      gl.bindAttribLocation(program, 0, "place");
      gl.bindAttribLocation(program, 1, "normal");
      gl.linkProgram(program);
      gl.useProgram(program);
      this.at = Object.fromEntries(["model", "view", "color", "lit"].map((name) => [name, gl.getUniformLocation(program, name)]));
      const solids = shapes.map((shape) => ({
        ...this.stored(triangles(shape, meshes)),
        body: shape.body,
        local: pose([...shape.position, ...shape.orientation]),
        color: shape.color,
        mode: gl.TRIANGLES,
      }));
      const outlines = workspaces.map(({ body, center, half }) => ({
        ...this.stored(edges(center, half)),
        body,
        local: pose([0, 0, 0, 1, 0, 0, 0]),
        color: [0.24, 0.55, 0.83, 1],
        mode: gl.LINES,
      }));
      // What is transparent is drawn last, over the rest.
      this.things = [...solids, ...outlines].sort((one, other) => other.color[3] - one.color[3]);
    }
    stored(numbers) {
      const gl = this.gl;
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
      return { buffer, count: numbers.length / 6 };
    }
    seek(time) {
      this.time = time;
      const { times, poses } = this;
      const width = this.moment.moving.length;
      let row = 0;
      while (row + 2 < times.length && times[row + 1] <= time) {
        row += 1;
      }
      const next = Math.min(row + 1, times.length - 1);
      const span = times[next] - times[row];
      const share = span > 0 ? Math.min(1, Math.max(0, (time - times[row]) / span)) : 0;
      for (const [column, body] of this.moment.moving.entries()) {
        const [from, to] = [row, next].map((one) => [...poses.subarray(7 * (one * width + column), 7 * (one * width + column) + 7)]);
        const same = dot(from.slice(3), to.slice(3)) < 0 ? -1 : 1; // q and −q are one orientation
        const mixed = from.map((value, index) => value + share * ((index < 3 ? to[index] : same * to[index]) - value));
        this.bodies[body] = [...mixed.slice(0, 3), ...normalized(mixed.slice(3))];
      }
      this.draw();
    }
    draw() {
      const { gl, canvas } = this;
      const scale = window.devicePixelRatio || 1;
      const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(1, Math.round(size * scale)));
      if (canvas.width !== width || canvas.height !== height) {
        Object.assign(canvas, { width, height });
      }
      gl.viewport(0, 0, width, height);
      gl.clearColor(0, 0, 0, 0);
      gl.depthMask(true);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.enable(gl.BLEND);
      gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.uniformMatrix4fv(this.at.view, false, camera(this.eye, width / height));
      const placed = this.bodies.map(pose);
      for (const { buffer, count, body, local, color, mode } of this.things) {
        gl.depthMask(color[3] >= 1);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        for (const place of [0, 1]) {
          gl.enableVertexAttribArray(place);
          gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 24, 12 * place);
        }
        gl.uniformMatrix4fv(this.at.model, false, body === null ? local : product(placed[body], local));
        gl.uniform4fv(this.at.color, color);
        gl.uniform1i(this.at.lit, mode === gl.TRIANGLES ? 1 : 0);
        gl.drawArrays(mode, 0, count);
      }
    }
    turn(yaw, pitch, nearer) {
      const eye = this.eye;
      eye.yaw += yaw;
      eye.pitch = Math.min(1.5, Math.max(-0.3, eye.pitch + pitch));
      eye.distance = Math.min(20, Math.max(0.15, eye.distance * nearer));
      this.draw();
    }
    steer() {
      const keys = { ArrowLeft: [-0.1, 0, 1], ArrowRight: [0.1, 0, 1], ArrowUp: [0, 0.1, 1], ArrowDown: [0, -0.1, 1], "+": [0, 0, 1 / 1.2], "=": [0, 0, 1 / 1.2], "-": [0, 0, 1.2] };
      this.canvas.addEventListener("keydown", (event) => {
        const change = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key];
        if (change !== undefined) {
          event.preventDefault();
          this.turn(...change);
        }
      });
      this.canvas.addEventListener("pointermove", (event) => {
        if (event.buttons === 1) {
          this.turn(-event.movementX / 150, event.movementY / 150, 1);
        }
      });
      this.canvas.addEventListener("pointerdown", (event) => this.canvas.setPointerCapture(event.pointerId));
      // The wheel scrolls the page unless the view has the focus.
      this.canvas.addEventListener("wheel", (event) => {
        if (document.activeElement === this.canvas) {
          event.preventDefault();
          this.turn(0, 0, 1.1 ** Math.sign(event.deltaY));
        }
      }, { passive: false });
    }
    dispose() {
      this.gl.getExtension("WEBGL_lose_context")?.loseContext();
    }
  }

  function made(name, attributes, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      element.setAttribute(key, value);
    }
    element.append(...children);
    return element;
  }

  // One replay is open at a time: browsers limit the number of WebGL contexts of a page.
  let close = () => {};
  function open(button) {
    close();
    const chosen = button.dataset.moments.split(",").map((number) => moments[Number(number)]);
    const figures = chosen.map(({ name }) => {
      const label = `3D view of ${name}. Arrow keys orbit, plus and minus zoom.`;
      const canvas = made("canvas", { tabindex: "0", role: "img", "aria-label": label });
      return { canvas, figure: made("figure", {}, canvas, made("figcaption", {}, name)) };
    });
    const root = made("div", { class: "replay" }, made("div", { class: "views" }, ...figures.map(({ figure }) => figure)));
    button.after(root);
    let views = [];
    try {
      views = chosen.map((moment, index) => new View(moment, figures[index].canvas));
    } catch {
      root.replaceChildren(made("p", {}, "This browser draws no 3D (WebGL 2)."));
    }
    let timer = 0;
    const start = Math.min(...chosen.map((moment, index) => (views[index]?.times[0] ?? moment.at)));
    const end = Math.max(...chosen.map((moment, index) => (views[index]?.times.at(-1) ?? moment.at)));
    const at = chosen[0].at;
    const slider = made("input", { type: "range", min: start, max: end, step: "any", value: at, "aria-label": "time" });
    const label = made("output", {});
    const play = made("button", { type: "button" }, "Play");
    const show = (time) => {
      slider.value = time;
      const away = time - at;
      label.textContent = Math.abs(away) < 0.005 ? `${at.toFixed(2)} s: ${chosen[0].what}` : `${time.toFixed(2)} s, ${Math.abs(away).toFixed(2)} s ${away < 0 ? "before" : "after"}`;
      slider.setAttribute("aria-valuetext", label.textContent);
      for (const view of views) {
        view.seek(time);
      }
    };
    const stop = () => {
      cancelAnimationFrame(timer);
      timer = 0;
      play.textContent = "Play";
    };
    play.addEventListener("click", () => {
      if (timer !== 0) {
        stop();
        return;
      }
      const from = Number(slider.value) >= end - 0.01 ? start : Number(slider.value);
      const began = performance.now();
      play.textContent = "Pause";
      const step = (now) => {
        const time = Math.min(end, from + (now - began) / 1000);
        show(time);
        timer = requestAnimationFrame(step);
        if (time >= end) {
          stop();
        }
      };
      timer = requestAnimationFrame(step);
    });
    slider.addEventListener("input", () => {
      stop();
      show(Number(slider.value));
    });
    if (views.length > 0) {
      root.append(made("p", { class: "clock" }, play, slider, label));
      show(at);
    }
    const resized = new ResizeObserver(() => views.forEach((view) => view.draw()));
    figures.forEach(({ canvas }) => resized.observe(canvas));
    button.setAttribute("aria-expanded", "true");
    button.textContent = "Close the replay";
    close = () => {
      stop();
      resized.disconnect();
      views.forEach((view) => view.dispose());
      root.remove();
      button.setAttribute("aria-expanded", "false");
      button.textContent = button.dataset.label;
      close = () => {};
    };
  }
  for (const button of document.querySelectorAll("button[data-moments]")) {
    button.hidden = false;
    button.dataset.label = button.textContent;
    button.addEventListener("click", () => (button.getAttribute("aria-expanded") === "true" ? close() : open(button)));
  }
})();
