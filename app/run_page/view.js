// Plays a run of Torsion's in a page: `run` as app/run_page/run_page.cpp writes it, three.js (r111) before this.
"use strict";
(function () {
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const floats = (text) => new Float32Array(bytes(text).buffer);
  const shorts = (text) => new Int16Array(bytes(text).buffer);
  const indices = (text) => new Uint32Array(bytes(text).buffer);
  const element = (id) => document.getElementById(id);

  const holder = element("view");
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch (problem) {
    document.body.dataset.fault = "WebGL";
    holder.innerHTML = '<p id="fault">This page needs WebGL, which the browser does not give: ' + problem.message +
      "</p>";
    return;
  }
  renderer.setPixelRatio(window.devicePixelRatio || 1);
  renderer.gammaOutput = true;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  holder.appendChild(renderer.domElement);

  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xdfe2e7).convertSRGBToLinear();
  scene.add(new THREE.HemisphereLight(0xf4f6fa, 0x8f8b85, 0.5));
  const box = new THREE.Box3();
  const last = run.times.length - 1;

  // A palette's colour for a signed share of the twist's scale, which goes by square roots.
  const palette = run.palette.map((c) => new THREE.Color(c[0], c[1], c[2]).convertSRGBToLinear());
  function colorOf(share) {
    const at = 0.5 + 0.5 * Math.sign(share) * Math.sqrt(Math.min(Math.abs(share), 1));
    return palette[Math.round(at * (palette.length - 1))];
  }

  function place(object, pose) {
    object.position.set(pose[0], pose[1], pose[2]);
    object.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
  }

  // The studio that surfaces mirror, a picture for each side of a cube.
  const studio = new THREE.CubeTexture(run.studio.map((side) => {
    const rgb = bytes(side);
    const width = Math.round(Math.sqrt(rgb.length / 3));
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = width;
    const context = canvas.getContext("2d");
    const pixels = context.createImageData(width, width);
    for (let i = 0; i < width * width; ++i) {
      pixels.data.set([rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], 255], 4 * i);
    }
    context.putImageData(pixels, 0, 0);
    return canvas;
  }));
  studio.encoding = THREE.sRGBEncoding;
  studio.needsUpdate = true;

  const images = run.images.map((address) => {
    const image = new Image();
    image.src = address;
    return image;
  });
  const wraps = { clamp: THREE.ClampToEdgeWrapping, mirror: THREE.MirroredRepeatWrapping, repeat: THREE.RepeatWrapping };

  // One of a material's textures, in the order of TextureRole; null without.
  function textureOf(look, role, encoded) {
    const wanted = look.textures[role];
    if (wanted.image < 0) return null;
    const image = images[wanted.image];
    const texture = new THREE.Texture(image);
    texture.wrapS = wraps[wanted.wrap[0]];
    texture.wrapT = wraps[wanted.wrap[1]];
    texture.flipY = false;
    texture.encoding = encoded ? THREE.sRGBEncoding : THREE.LinearEncoding;
    const ready = () => { texture.needsUpdate = true; };
    if (image.complete) ready(); else image.addEventListener("load", ready);
    return texture;
  }

  // A material as its file has it. What nobody said is opaque of bodies, glass of tools.
  function authored(look, isTool) {
    const glass = look.alpha === "blend" || (look.alpha === "unsaid" && isTool);
    const metalRoughness = textureOf(look, 1, false);
    const material = new THREE.MeshStandardMaterial({
      color: new THREE.Color(look.color[0], look.color[1], look.color[2]),
      metalness: look.metal,
      roughness: look.roughness,
      emissive: new THREE.Color(look.emission[0], look.emission[1], look.emission[2]),
      envMap: studio,
      envMapIntensity: 0.6,
      side: look.double_sided ? THREE.DoubleSide : THREE.FrontSide,
      map: textureOf(look, 0, true),
      metalnessMap: metalRoughness,
      roughnessMap: metalRoughness,
      normalMap: textureOf(look, 2, false),
      aoMap: textureOf(look, 3, false),
      aoMapIntensity: look.occlusion_strength,
      emissiveMap: textureOf(look, 4, true),
      transparent: glass,
      opacity: !glass ? 1 : look.alpha === "blend" ? look.color[3] : 0.4,
      depthWrite: !glass,
      alphaTest: look.alpha === "mask" ? look.cutoff : 0,
    });
    if (look.alpha === "mask") material.opacity = look.color[3];
    // Green is against v (glTF), and the picture is not turned over.
    material.normalScale.set(look.normal_scale, -look.normal_scale);
    return material;
  }

  // What is cut out of a mesh of one material is cut out of its shadow.
  function castShadow(mesh, looks) {
    mesh.castShadow = true;
    if (looks.length === 1 && looks[0].alpha === "mask") {
      mesh.customDepthMaterial = new THREE.MeshDepthMaterial({
        depthPacking: THREE.RGBADepthPacking, map: textureOf(looks[0], 0, true), alphaTest: looks[0].cutoff,
      });
    }
  }

  // A mesh's triangles, one group for each run of one material, and what is on them.
  function addLook(geometry, look) {
    look.runs.forEach((each, i) => geometry.addGroup(3 * each[0], 3 * each[1], i));
    if (look.texcoords) {
      geometry.setAttribute("uv", new THREE.BufferAttribute(floats(look.texcoords), 2));
      geometry.setAttribute("uv2", geometry.attributes.uv);
    }
    return look.runs.map((each) => run.materials[each[2]]);
  }

  // Lines that are fixed to the material, a thick one every fifth.
  function lined(material, spacing) {
    if (!run.lines) return material;
    material.extensions = { derivatives: true };
    material.onBeforeCompile = (shader) => {
      shader.uniforms.spacing = { value: spacing };
      shader.vertexShader = "attribute vec3 rest;\nvarying vec3 at_rest;\n" + shader.vertexShader.replace(
        "#include <begin_vertex>", "#include <begin_vertex>\n  at_rest = rest;");
      shader.fragmentShader = `varying vec3 at_rest;
uniform float spacing;
float line(float at, float width, float gap, float pixels) {
  float beside = abs(fract(at / gap + 0.5) - 0.5) * gap;
  return 1.0 - smoothstep(pixels - 0.5, pixels + 0.5, beside / max(width, 1e-9));
}
` + shader.fragmentShader.replace("#include <color_fragment>", `#include <color_fragment>
  vec3 across = normalize(cross(dFdx(at_rest), dFdy(at_rest)));
  vec3 pixel = fwidth(at_rest);
  float dark = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (abs(across[i]) < 0.95) {
      dark = max(dark, 0.45 * line(at_rest[i], pixel[i], spacing, 0.6));
      dark = max(dark, 0.8 * line(at_rest[i], pixel[i], 5.0 * spacing, 1.2));
    }
  }
  diffuseColor.rgb *= 1.0 - dark;`);
    };
    return material;
  }

  const bodies = run.bodies.map((body) => {
    const rest = floats(body.positions);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(rest.slice(), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(floats(body.normals), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(rest.length), 3));
    geometry.setIndex(new THREE.BufferAttribute(indices(body.triangles), 1));
    geometry.setAttribute("rest", new THREE.BufferAttribute(rest, 3));
    const looks = addLook(geometry, body.look);
    const twisted = lined(new THREE.MeshStandardMaterial({
      vertexColors: THREE.VertexColors, roughness: 0.65, metalness: 0,
    }), body.grid);
    const dressed = looks.map((look) => {
      const material = lined(authored(look, false), body.grid);
      material.vertexColors = THREE.VertexColors;
      return material;
    });
    const mesh = new THREE.Mesh(geometry, dressed);
    castShadow(mesh, looks);
    mesh.receiveShadow = true;
    place(mesh, body.pose);
    scene.add(mesh);
    mesh.updateMatrixWorld();
    box.expandByObject(mesh);
    const paint = body.look.paint ? floats(body.look.paint) : new Float32Array(rest.length).fill(1);
    return { mesh, twisted: looks.map(() => twisted), dressed, paint, poses: body.poses, rest, shifts: shorts(body.shifts), unit: body.shift_unit, twists: shorts(body.twists),
      normals: floats(body.normals), normalShifts: shorts(body.normal_shifts) };
  });

  const size = box.getSize(new THREE.Vector3());
  const side = Math.max(size.x, size.y, size.z);
  const middle = box.getCenter(new THREE.Vector3());

  const paint = (color) => new THREE.MeshStandardMaterial({
    color: new THREE.Color(color).convertSRGBToLinear(), roughness: 0.5,
  });

  // Along +y, of length 1.
  function straightArrow(color) {
    const arrow = new THREE.Group();
    const shaft = new THREE.Mesh(new THREE.CylinderBufferGeometry(0.02 * side, 0.02 * side, 1, 20), paint(color));
    const tip = new THREE.Mesh(new THREE.ConeBufferGeometry(0.055 * side, 0.14 * side, 28), paint(color));
    arrow.add(shaft, tip);
    scene.add(arrow);
    return {
      show(tail, vector) {
        const length = vector.length();
        arrow.visible = length > 0.01 * side;
        if (!arrow.visible) return;
        const head = Math.min(0.14 * side, 0.6 * length);
        shaft.scale.set(1, Math.max(length - head, 1e-6), 1);
        shaft.position.y = 0.5 * (length - head);
        tip.scale.setScalar(head / (0.14 * side));
        tip.position.y = length - 0.5 * head;
        arrow.position.copy(tail);
        arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), vector.clone().normalize());
      },
    };
  }

  // Around +z, from 30 to 330 degrees at most.
  function bentArrow(radius, color) {
    const from = Math.PI / 6;
    const most = 5 * Math.PI / 3;
    const steps = 96;
    const around = new THREE.Curve();
    around.getPoint = (share) => new THREE.Vector3(radius * Math.cos(from + share * most),
      radius * Math.sin(from + share * most), 0);
    const tube = new THREE.Mesh(new THREE.TubeBufferGeometry(around, steps, 0.018 * side, 14), paint(color));
    const tip = new THREE.Mesh(new THREE.ConeBufferGeometry(0.05 * side, 0.12 * side, 28), paint(color));
    const arc = new THREE.Group();
    arc.add(tube, tip);
    scene.add(arc);
    const each = tube.geometry.index.count / steps;
    return {
      show(center, axis, share) {
        arc.visible = share > 0.01;
        if (!arc.visible) return;
        tube.geometry.setDrawRange(0, each * Math.max(Math.floor(steps * share), 1));
        const end = from + Math.floor(steps * share) / steps * most;
        tip.position.set(radius * Math.cos(end), radius * Math.sin(end), 0);
        tip.rotation.set(0, 0, end);
        arc.position.copy(center);
        arc.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis);
      },
    };
  }

  // A thing's pose between two moments.
  function move(mesh, poses, row, after, share) {
    const next = new THREE.Object3D();
    place(mesh, poses[row]);
    place(next, poses[after]);
    mesh.position.lerp(next.position, share);
    mesh.quaternion.slerp(next.quaternion, share);
  }

  const tools = run.tools.map((tool) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(floats(tool.positions), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(floats(tool.normals), 3));
    geometry.setIndex(new THREE.BufferAttribute(indices(tool.triangles), 1));
    if (tool.look.paint) geometry.setAttribute("color", new THREE.BufferAttribute(floats(tool.look.paint), 3));
    const looks = addLook(geometry, tool.look);
    const mesh = new THREE.Mesh(geometry, looks.map((look) => {
      const material = authored(look, true);
      if (tool.look.paint) material.vertexColors = THREE.VertexColors;
      return material;
    }));
    castShadow(mesh, looks);
    scene.add(mesh);
    const own = new THREE.Box3().setFromBufferAttribute(geometry.attributes.position);
    const radius = Math.min(Math.max(0.62 * Math.min(...own.getSize(new THREE.Vector3()).toArray()), 0.25 * side),
      0.75 * side);
    return { mesh, arrow: straightArrow(0x276fc4), arc: bentArrow(radius, 0xcc7300), poses: tool.poses, forces: tool.forces, torques: tool.torques, centers: tool.centers };
  });

  const sun = new THREE.DirectionalLight(0xfff6e8, 0.55);
  sun.position.copy(middle).add(new THREE.Vector3(-1.2, 2.6, 1.4).multiplyScalar(side));
  sun.target.position.copy(middle);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.bias = -1e-4;
  Object.assign(sun.shadow.camera, { left: -1.6 * side, right: 1.6 * side, top: 1.6 * side, bottom: -1.6 * side,
    near: 0.1 * side, far: 8 * side });
  scene.add(sun, sun.target);
  const floor = new THREE.Mesh(new THREE.PlaneBufferGeometry(20 * side, 20 * side),
    new THREE.ShadowMaterial({ opacity: 0.18 }));
  floor.rotation.x = -Math.PI / 2;
  floor.position.y = box.min.y - 1e-4 * side;
  floor.receiveShadow = true;
  scene.add(floor);

  const camera = new THREE.PerspectiveCamera(30, 1, 0.01 * side, 100 * side);
  const look = run.camera;
  camera.position.set(look.eye[0], look.eye[1], look.eye[2]);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.target.set(look.target[0], look.target[1], look.target[2]);
  controls.update();

  // Between the moments before and after, everything goes linearly.
  function blend(list, row, share) {
    const next = list[Math.min(row + 1, last)];
    return list[row].map((value, i) => value + share * (next[i] - value));
  }

  function show(time) {
    let row = 0;
    while (row < last - 1 && run.times[row + 1] <= time) row += 1;
    const span = last > 0 ? run.times[row + 1] - run.times[row] : 1;
    const share = last > 0 ? Math.min(Math.max((time - run.times[row]) / span, 0), 1) : 0;
    const after = Math.min(row + 1, last);
    for (const body of bodies) {
      if (body.poses.length > 0) move(body.mesh, body.poses, row, after, share);
      const attributes = body.mesh.geometry.attributes;
      const count = body.rest.length;
      for (let i = 0; i < count; ++i) {
        const a = body.shifts[row * count + i];
        const b = body.shifts[after * count + i];
        attributes.position.array[i] = body.rest[i] + body.unit * (a + share * (b - a));
        const c = body.normalShifts[row * count + i];
        const d = body.normalShifts[after * count + i];
        attributes.normal.array[i] = body.normals[i] + (c + share * (d - c)) / 16383;
      }
      const vertices = count / 3;
      for (let i = 0; i < vertices && colors === "twist"; ++i) {
        const a = body.twists[row * vertices + i];
        const b = body.twists[after * vertices + i];
        const color = colorOf((a + share * (b - a)) / 32767);
        attributes.color.array[3 * i] = color.r;
        attributes.color.array[3 * i + 1] = color.g;
        attributes.color.array[3 * i + 2] = color.b;
      }
      attributes.position.needsUpdate = true;
      attributes.normal.needsUpdate = true;
      attributes.color.needsUpdate = true;
    }
    let force = 0;
    let torque = 0;
    for (const tool of tools) {
      move(tool.mesh, tool.poses, row, after, share);
      const f = new THREE.Vector3().fromArray(blend(tool.forces, row, share));
      force = Math.max(force, f.length());
      torque = Math.max(torque, new THREE.Vector3().fromArray(blend(tool.torques, row, share)).length());
      const center = new THREE.Vector3().fromArray(blend(tool.centers, row, share));
      const t = new THREE.Vector3().fromArray(blend(tool.torques, row, share));
      tool.arrow.show(center, f.clone().multiplyScalar(0.6 * side / run.full_force));
      tool.arc.show(center, t.clone().normalize(), t.length() / run.full_torque);
    }
    element("now").textContent = time.toFixed(2) + " s";
    element("force").textContent = "force " + force.toPrecision(3) + " N";
    element("torque").textContent = "torque " + torque.toPrecision(3) + " N m";
  }

  // Force and torque over time, each over its largest.
  const plots = element("plots");
  function plot(time) {
    const ratio = window.devicePixelRatio || 1;
    const width = plots.width = plots.clientWidth * ratio;
    const height = plots.height = plots.clientHeight * ratio;
    const draw = plots.getContext("2d");
    const x = (t) => 12 * ratio + (width - 24 * ratio) * (run.times[last] > 0 ? t / run.times[last] : 0);
    const curve = (values, color) => {
      const most = Math.max.apply(null, values) || 1;
      draw.beginPath();
      values.forEach((value, i) => draw.lineTo(x(run.times[i]), height * (0.92 - 0.84 * value / most)));
      draw.strokeStyle = color;
      draw.lineWidth = 2 * ratio;
      draw.stroke();
    };
    const sizes = (key) => run.times.map((t, i) => Math.max.apply(null, run.tools.map((tool) =>
      Math.hypot(tool[key][i][0], tool[key][i][1], tool[key][i][2]))));
    curve(sizes("forces"), "#276fc4");
    curve(sizes("torques"), "#cc7300");
    draw.fillStyle = "#1a1c21";
    draw.fillRect(x(time) - ratio, 0, 2 * ratio, height);
  }

  const ramp = document.querySelector("#scale canvas").getContext("2d");
  for (let i = 0; i < 220; ++i) {
    const c = run.palette[Math.round(i / 219 * (run.palette.length - 1))];
    ramp.fillStyle = "rgb(" + c.map((part) => Math.round(255 * part)).join(",") + ")";
    ramp.fillRect(i, 0, 1, 1);
  }
  element("low").textContent = (-run.twist_limit).toPrecision(3);
  element("high").textContent = run.twist_limit.toPrecision(3);

  // Of bodies: the twist, or their materials under the studio's light.
  let colors = run.colors;
  function dress() {
    element("scale").style.display = colors === "twist" ? "" : "none";
    for (const body of bodies) {
      body.mesh.material = colors === "twist" ? body.twisted : body.dressed;
      if (colors === "material") body.mesh.geometry.attributes.color.array.set(body.paint);
    }
  }
  element("colors").value = colors;
  element("colors").addEventListener("change", () => {
    colors = element("colors").value;
    dress();
  });
  dress();

  let playing = true;
  let time = 0;
  let before = null;
  element("time").max = run.times[last];
  element("time").addEventListener("input", (event) => {
    playing = false;
    element("play").textContent = "Play";
    time = Number(event.target.value);
  });
  element("play").addEventListener("click", () => {
    playing = !playing;
    element("play").textContent = playing ? "Pause" : "Play";
  });
  function resize() {
    renderer.setSize(holder.clientWidth, holder.clientHeight);
    camera.aspect = holder.clientWidth / Math.max(holder.clientHeight, 1);
    camera.updateProjectionMatrix();
  }
  window.addEventListener("resize", resize);
  resize();
  // page.html#1.5 stands still there.
  const wanted = parseFloat(window.location.hash.slice(1));
  if (isFinite(wanted)) {
    playing = false;
    element("play").textContent = "Play";
    time = Math.min(Math.max(wanted, 0), run.times[last]);
  }
  function frame(now) {
    if (playing && before !== null && run.times[last] > 0) {
      time = (time + 1e-3 * (now - before) * Number(element("speed").value)) % run.times[last];
    }
    before = now;
    element("time").value = time;
    show(time);
    plot(time);
    controls.update();
    renderer.render(scene, camera);
    document.body.dataset.drawn = String(Number(document.body.dataset.drawn || 0) + 1);
    document.body.dataset.triangles = String(renderer.info.render.triangles);
    window.requestAnimationFrame(frame);
  }
  window.requestAnimationFrame(frame);
})();
