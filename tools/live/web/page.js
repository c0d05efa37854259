// SPDX-License-Identifier: MIT
// Draws the events of a live run (see README.md): "status" twice a second, "frame" up to ten times, "map" once.
(function () {
  'use strict';
  const element = (id) => document.getElementById(id);
  const root = document.documentElement;
  const colour = (name) => getComputedStyle(root).getPropertyValue('--' + name).trim();
  const text = (id, value) => { const e = element(id); if (e.textContent !== value) e.textContent = value; };
  const count = (value) => value.toLocaleString('en').replace(/,/g, '\u2009');
  const ms = (value) => value >= 100 ? value.toFixed(0) : value >= 10 ? value.toFixed(1) : value.toFixed(2);

  let status = null;
  let frame = null;   // newest image with its features
  let map = null;
  let lost = false;   // no connection
  let drawing = false;

  // ---- figures ----

  function figure(id, value, unit) {
    const e = element(id);
    e.textContent = value;
    if (!unit) return;
    const small = document.createElement('small');
    small.textContent = '\u2009' + unit;
    e.append(small);
  }

  const kinds = { tracking: 'good', relocalised: 'good', init: '', degraded: 'warn', lost: 'bad' };

  function showStatus() {
    const s = status;
    text('source', s.source);
    text('about', 'unisim-live ' + s.version + (s.segment > 0
      ? ', part ' + (s.segment + 1) + ' of the map: track was lost before, scale and place began anew' : ''));
    element('state').className = 'pill ' + (lost ? '' : kinds[s.state] || '');
    text('state', lost ? 'no connection' : s.state + (s.reason ? ': ' + s.reason : ''));
    document.title = s.state + ' \u2013 unisim-live';
    figure('rate', s.frames_per_second.toFixed(1));
    text('rate-note', count(s.frames) + ' in all' + (s.frames_bad ? ', ' + count(s.frames_bad) + ' unreadable' : ''));
    figure('age', s.pose_age_p50_ms.toFixed(0), 'ms');
    text('age-note', 'p95 ' + s.pose_age_p95_ms.toFixed(0) + ', p99 ' + s.pose_age_p99_ms.toFixed(0));
    figure('dropped', count(s.frames_dropped));
    text('dropped-note', 'late, for newer ones');
    figure('keyframes', count(s.keyframes));
    text('keyframes-note', count(s.submaps) + ' submaps, ' + count(s.loops) + ' loops');
    figure('memory', s.memory_mb.toFixed(0), 'MB');
    text('memory-note', s.temperature_c === null ? '' : 'board at ' + s.temperature_c.toFixed(0) + ' \u00b0C');
    const metric = s.unit === 'metric';
    figure('unit', metric ? 'metres' : 'relative');
    text('unit-note', metric ? '\u00b1 ' + (100 * s.scale_sigma).toPrecision(2) + ' %, 1 unit = '
      + s.metres_per_unit.toPrecision(3) + ' m' : 'no metre is known');
    showStages(s.stages);
    showMessages(s.messages);
    showBanner();
  }

  function showBanner() {
    const silent = status && status.silent_s > 2;
    element('banner').hidden = !lost && !silent;
    text('banner', lost ? 'The connection to the robot is lost; trying again.'
      : silent ? 'No frame for ' + status.silent_s.toFixed(0) + ' s. Is the camera plugged in?' : '');
  }

  function showStages(stages) {
    const body = element('stages');
    const widest = Math.max(1e-9, ...stages.map((stage) => stage.p95_ms));
    while (body.rows.length > stages.length) body.deleteRow(-1);
    stages.forEach((stage, k) => {
      let row = body.rows[k];
      if (!row) {
        row = body.insertRow();
        for (let cell = 0; cell < 6; ++cell) row.insertCell();
        row.cells[5].className = 'bar';
        row.cells[5].append(document.createElement('b'));
      }
      const values = [stage.name, count(stage.count), ms(stage.p50_ms), ms(stage.p95_ms), ms(stage.max_ms)];
      values.forEach((value, cell) => { row.cells[cell].textContent = value; });
      row.cells[5].firstChild.style.width = (100 * stage.p95_ms / widest).toFixed(1) + '%';
    });
  }

  function showMessages(lines) {
    const list = element('messages');
    element('messages-empty').hidden = lines.length > 0;
    if (list.dataset.lines === lines.join('\n')) return;
    list.dataset.lines = lines.join('\n');
    list.replaceChildren(...lines.slice().reverse().map((line) => {
      const item = document.createElement('li');
      item.textContent = line;
      return item;
    }));
  }

  // ---- canvases ----

  /// Fits the bitmap to the screen; drawing is in CSS pixels.
  function prepare(canvas) {
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const pen = canvas.getContext('2d');
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    return { pen, width, height };
  }

  function drawCamera() {
    element('camera-empty').hidden = frame !== null;
    if (!frame) return;
    element('camera').parentNode.style.aspectRatio = frame.width + ' / ' + frame.height;
    const { pen, width, height } = prepare(element('camera'));
    const scale = Math.min(width / frame.width, height / frame.height);
    const left = (width - scale * frame.width) / 2;
    const top = (height - scale * frame.height) / 2;
    pen.drawImage(frame.picture, left, top, scale * frame.width, scale * frame.height);
    const f = frame.features;
    let placed = 0;
    for (const known of [0, 1]) {
      pen.beginPath();
      for (let k = 0; k < f.length; k += 3) {
        if (f[k + 2] !== known) continue;
        placed += known;
        const x = left + scale * (f[k] + 0.5);
        const y = top + scale * (f[k + 1] + 0.5);
        pen.moveTo(x + 3, y);
        pen.arc(x, y, known ? 2.2 : 3, 0, 7);
      }
      pen.lineWidth = 1.6;
      if (known) { pen.fillStyle = '#3ddc97'; pen.fill(); } else { pen.strokeStyle = '#ffa53d'; pen.stroke(); }
    }
    text('placed', String(placed));
    text('unplaced', String(f.length / 3 - placed));
  }

  /// Bounds of what is to be seen, in units of the map.
  function bounds() {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    const add = (x, y) => {
      x0 = Math.min(x0, x); x1 = Math.max(x1, x);
      y0 = Math.min(y0, y); y1 = Math.max(y1, y);
    };
    for (const list of [map.corrected, map.live, map.cloud]) {
      for (let k = 0; k < list.length; k += 2) {
        add(map.corner[0] + map.step * list[k], map.corner[1] + map.step * list[k + 1]);
      }
    }
    if (frame && frame.camera && frame.segment === map.segment) add(frame.camera[0], frame.camera[1]);
    return x0 <= x1 ? { x0, y0, x1, y1 } : null;
  }

  /// 1, 2 or 5 times a power of ten, near `value`.
  function roundLength(value) {
    const power = Math.pow(10, Math.floor(Math.log10(value)));
    const lead = value / power;
    return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
  }

  function drawGrid(pen, width, height, place, box, unit) {
    const metric = status && status.unit === 'metric';
    const metres = metric ? status.metres_per_unit : 1;
    const length = roundLength(90 / unit * metres);
    const step = length / metres;
    pen.strokeStyle = colour('edge');
    pen.lineWidth = 1;
    pen.beginPath();
    const [left, bottom] = [place.toX(0), place.toY(0)];
    for (let x = box.x0 - left / unit; x <= box.x0 + (width - left) / unit + step; x += step) {
      const at = Math.round(place.toX(Math.ceil(x / step) * step - box.x0)) + 0.5;
      pen.moveTo(at, 0); pen.lineTo(at, height);
    }
    for (let y = box.y0 - (height - bottom) / unit; y <= box.y0 + bottom / unit + step; y += step) {
      const at = Math.round(place.toY(Math.ceil(y / step) * step - box.y0)) + 0.5;
      pen.moveTo(0, at); pen.lineTo(width, at);
    }
    pen.stroke();
    pen.strokeStyle = pen.fillStyle = colour('soft');
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(14, height - 18); pen.lineTo(14, height - 13);
    pen.lineTo(14 + step * unit, height - 13); pen.lineTo(14 + step * unit, height - 18);
    pen.stroke();
    pen.font = '12px system-ui, sans-serif';
    const name = metric ? ' m' : (length === 1 ? ' unit' : ' units') + ' of the map';
    pen.fillText(+length.toPrecision(1) + name, 20, height - 20);
  }

  function drawPath(pen, list, toPage, style, width) {
    pen.strokeStyle = style;
    pen.lineWidth = width;
    pen.lineJoin = 'round';
    pen.beginPath();
    for (let k = 0; k < list.length; k += 2) {
      const [x, y] = toPage(list[k], list[k + 1]);
      if (k === 0) pen.moveTo(x, y); else pen.lineTo(x, y);
    }
    pen.stroke();
  }

  function drawCloud(pen, toPage) {
    const heights = map.heights;
    if (!heights.length) return;
    const sorted = heights.slice().sort((a, b) => a - b);
    const low = sorted[Math.floor(0.05 * (sorted.length - 1))];
    const high = sorted[Math.floor(0.95 * (sorted.length - 1))];
    const levels = 6;
    pen.globalAlpha = 0.75;
    for (let level = 0; level < levels; ++level) {
      pen.fillStyle = 'color-mix(in srgb, ' + colour('high') + ' ' + (100 * level / (levels - 1)) + '%, ' + colour('low') + ')';
      for (let k = 0; k < heights.length; ++k) {
        const share = high > low ? (heights[k] - low) / (high - low) : 0;
        if (Math.round(Math.min(1, Math.max(0, share)) * (levels - 1)) !== level) continue;
        const [x, y] = toPage(map.cloud[2 * k], map.cloud[2 * k + 1]);
        pen.fillRect(x - 0.9, y - 0.9, 1.8, 1.8);
      }
    }
    pen.globalAlpha = 1;
  }

  function drawMarker(pen, x, y, across, ahead) {
    const length = Math.hypot(across, ahead);
    const angle = length > 1e-12 ? Math.atan2(-ahead, across) : -Math.PI / 2;
    pen.save();
    pen.translate(x, y);
    pen.rotate(angle);
    pen.beginPath();
    pen.moveTo(10, 0); pen.lineTo(-7, 6.5); pen.lineTo(-3.5, 0); pen.lineTo(-7, -6.5);
    pen.closePath();
    pen.fillStyle = colour('ink');
    pen.strokeStyle = colour('card');
    pen.lineWidth = 2;
    pen.stroke();
    pen.fill();
    pen.restore();
  }

  function drawMap() {
    const box = map && (map.corrected.length || map.live.length) ? bounds() : null;
    element('map-empty').hidden = box !== null;
    const { pen, width, height } = prepare(element('map'));
    if (!box) return;
    const margin = 40;  // the length at the bottom has room
    const side = Math.max(box.x1 - box.x0, box.y1 - box.y0, 1e-9);
    const unit = Math.min((width - 2 * margin) / Math.max(box.x1 - box.x0, 0.02 * side),
      (height - 2 * margin) / Math.max(box.y1 - box.y0, 0.02 * side));
    const left = (width - unit * (box.x1 - box.x0)) / 2;
    const bottom = (height + unit * (box.y1 - box.y0)) / 2;
    const place = { toX: (x) => left + unit * x, toY: (y) => bottom - unit * y };
    const toPage = (x, y) => [place.toX(map.corner[0] + map.step * x - box.x0),
      place.toY(map.corner[1] + map.step * y - box.y0)];
    drawGrid(pen, width, height, place, box, unit);
    drawCloud(pen, toPage);
    drawPath(pen, map.live, toPage, colour('live'), 1.4);
    drawPath(pen, map.corrected, toPage, colour('corrected'), 2.2);
    if (!frame || !frame.camera || frame.segment !== map.segment) return;
    const [x, y, across, ahead] = frame.camera;
    drawMarker(pen, place.toX(x - box.x0), place.toY(y - box.y0), across, ahead);
  }

  function redraw() {
    if (drawing) return;
    drawing = true;
    requestAnimationFrame(() => {
      drawing = false;
      drawCamera();
      drawMap();
    });
  }

  // ---- events ----

  const events = new EventSource('events' + location.search);
  events.addEventListener('status', (event) => { status = JSON.parse(event.data); lost = false; showStatus(); });
  events.addEventListener('map', (event) => { map = JSON.parse(event.data); redraw(); });
  events.addEventListener('frame', (event) => {
    const next = JSON.parse(event.data);
    next.picture = new Image();
    next.picture.onload = () => { frame = next; redraw(); };
    next.picture.src = 'data:image/jpeg;base64,' + next.jpeg;
    next.jpeg = null;
  });
  events.onerror = () => { lost = true; if (status) showStatus(); else showBanner(); };
  window.addEventListener('resize', redraw);
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
})();
