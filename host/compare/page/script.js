// Moves the points of the Pareto charts and sorts the table as the slider and the choice of rays say. Everything else
// on the page stands without it.
'use strict';
(() => {
  const data = JSON.parse(document.getElementById('lines').textContent);
  const gap = 16.5;

  // As words.cpp writes them.
  function significant(value, digits) {
    if (value === 0) return '0';
    if (value < 1e-3 || value >= 1e6) return value.toExponential(digits - 1);
    const rounded = value * (1 + 0.5 * 10 ** -digits);
    return value.toFixed(Math.max(0, digits - Math.floor(Math.log10(rounded)) - 1));
  }
  function time_text(seconds) {
    for (const [scale, unit] of [[1, ' s'], [1e-3, ' ms'], [1e-6, ' µs']])
      if (seconds >= scale) return significant(seconds / scale, 3) + unit;
    return significant(seconds * 1e9, 3) + ' ns';
  }
  function count_text(count) {
    for (const [scale, unit] of [[1e12, ' trillion'], [1e9, ' billion'], [1e6, ' million']])
      if (count >= 0.9995 * scale) return significant(count / scale, 2) + unit;
    return count >= 9995 ? significant(count / 1e3, 2) + ' thousand' : count.toFixed(0);
  }

  // As plots.cpp does it.
  function place_letters(points, frame) {
    const placed = [];
    for (const point of points) {
      let best = point;
      for (let step = 0; step < 80; ++step) {
        const ring = Math.floor((step + 7) / 8);
        const angle = 0.25 * Math.PI * step + 0.4 * ring;
        const at = {x: point.x + gap * ring * Math.cos(angle), y: point.y - gap * ring * Math.sin(angle)};
        const inside = at.x >= frame.left && at.x <= frame.right && at.y >= point.top && at.y <= frame.bottom;
        if (step !== 0 && !inside) continue;
        if (placed.some(other => Math.hypot(other.x - at.x, other.y - at.y) < gap)) continue;
        best = at;
        break;
      }
      placed.push(best);
    }
    return placed;
  }

  function redraw_chart(svg, times) {
    const number = name => parseFloat(svg.dataset[name]);
    const [lo, hi, left, right, top, bottom] = ['lo', 'hi', 'left', 'right', 'top', 'bottom'].map(number);
    const dots = [...svg.querySelectorAll('.dot')];
    const stems = [...svg.querySelectorAll('.stem')];
    const points = dots.map(dot => ({
      x: left + (right - left) * (Math.log10(times.get(dot.dataset.letter)) - lo) / (hi - lo),
      y: parseFloat(dot.dataset.y),
      top: parseFloat(dot.dataset.top),
    }));
    const letters = place_letters(points, {left: left + 4, right: right - 4, bottom: bottom - 8});
    dots.forEach((dot, i) => {
      const [lead, mark] = stems[i].children;
      const {x, y} = points[i];
      lead.setAttribute('x1', x);
      lead.setAttribute('y1', y);
      lead.setAttribute('x2', letters[i].x);
      lead.setAttribute('y2', letters[i].y);
      mark.setAttribute('d', `M${x - 2} ${y}a2 2 0 1 0 4 0a2 2 0 1 0 -4 0z`);
      dot.firstElementChild.setAttribute('transform', `translate(${letters[i].x.toFixed(1)} ${letters[i].y.toFixed(1)})`);
    });
    // Those that none beats in both: lower on the page is less.
    const order = points.map((point, i) => i).sort((a, b) => points[a].x - points[b].x || points[b].y - points[a].y);
    let path = '';
    let reached = top;
    for (const i of order) {
      if (path !== '' && points[i].y <= reached) continue;
      path += (path === '' ? `M${points[i].x} ${top}` : `H${points[i].x}`) + `V${points[i].y}`;
      reached = points[i].y;
    }
    svg.querySelector('.front').setAttribute('d', path + `H${right}`);
  }

  function redraw(section, device) {
    const slider = section.querySelector('input');
    const kind = section.querySelector('select').value;
    const rays = 10 ** parseFloat(slider.value);
    const lines = device.lines[kind];
    const total = line => line.build_s + rays * line.ray_s;
    const base = lines.find(line => line.method === data.baseline);
    const times = new Map(lines.map(line => [line.letter, total(line) / total(base)]));
    section.querySelectorAll('svg[data-lo]').forEach(svg => redraw_chart(svg, times));
    const body = section.querySelector('tbody');
    const rows = new Map([...body.rows].map(row => [row.dataset.letter, row]));
    for (const line of [...lines].sort((a, b) => total(a) - total(b))) {
      const row = rows.get(line.letter);
      row.querySelector('.time').textContent = time_text(total(line));
      row.querySelector('.ratio').textContent = (total(line) / total(base)).toFixed(2);
      body.append(row);
    }
    section.querySelector('output').textContent =
        `${count_text(rays)} rays${kind === 'all' ? '' : ` of ${kind}`} after one build: ${data.baseline} takes ${time_text(total(base))}`;
  }

  // report.html#rays=1e9&kind=bounce shows just that.
  const wish = new URLSearchParams(location.hash.slice(1));
  data.devices.forEach((device, i) => {
    const section = document.getElementById('device-' + i);
    const slider = section.querySelector('input');
    if (slider === null) return;
    const kinds = section.querySelector('select');
    if (parseFloat(wish.get('rays')) > 0) slider.value = Math.log10(parseFloat(wish.get('rays')));
    if (device.lines[wish.get('kind')] !== undefined) kinds.value = wish.get('kind');
    slider.addEventListener('input', () => redraw(section, device));
    kinds.addEventListener('input', () => redraw(section, device));
    redraw(section, device);
  });
})();
