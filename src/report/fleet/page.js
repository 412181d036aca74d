'use strict';
const fleet = JSON.parse(document.getElementById('data').textContent), lights = fleet.lights;
const find = document.getElementById('find'), body = document.getElementById('body'), more = document.getElementById('more');
const count = document.getElementById('count'), buttons = [...document.querySelectorAll('.lights button')];
const labels = [...document.querySelectorAll('.fleet thead th')].map(head => head.textContent), STEP = 100;
// Rows that are drawn, and names of those that are open.
const drawn = new Map(), opened = new Set();
let chosen = -1, hits = [], until = STEP;
const put = (tag, text, of) => { const e = document.createElement(tag); e.textContent = text; Object.assign(e, of); return e; };
// All of a row's text goes in as text, never as markup.
function spark(points, limit, words) {
  const known = points.filter(p => p !== null);
  if (known.length < 2) return put('span', '');
  const low = Math.min(limit, ...known), high = Math.max(limit, ...known), span = Math.max(high - low, 1);
  const y = p => (23 - 20 * (p - low) / span).toFixed(1), x = k => (94 * k / (points.length - 1) + 1).toFixed(1);
  const at = (name, of) => { const e = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const key in of) e.setAttribute(key, of[key]); return e; };
  const svg = at('svg', { viewBox: '0 0 96 26', role: 'img', 'aria-label': words });
  svg.append(at('line', { x1: 1, x2: 95, y1: y(limit), y2: y(limit), stroke: '#b3261e', 'stroke-dasharray': '3 2' }));
  const line = points.map((p, k) => p === null ? '' : x(k) + ',' + y(p)).filter(p => p).join(' ');
  svg.append(at('polyline', { points: line, fill: 'none', stroke: '#00558c', 'stroke-width': 1.6 }));
  return svg;
}
function detail(one) {
  const row = put('tr', '', { className: 'detail' }), cell = put('td', '', { colSpan: labels.length });
  const table = put('table', '', { className: 'facts' });
  for (const [name, value] of one.f) { const line = put('tr', ''); line.append(put('th', name), put('td', value)); table.append(line); }
  cell.append(table);
  for (const [title, lines] of [['Last events', one.e], ['Cautions', one.c]]) if (lines.length) {
    const list = put('ul', ''); lines.forEach(line => list.append(put('li', line))); cell.append(put('p', title), list); }
  row.append(cell); return row;
}
// Puts into a row what is new in it.
function fill(row, one) {
  const light = row.children[0].firstChild, words = lights[one.l];
  if (light.textContent !== words) { light.textContent = words; light.className = 'light ' + words; }
  one.w.forEach((text, k) => { const cell = row.children[k + 2]; if (cell.textContent !== text) cell.textContent = text; });
  row.lastChild.replaceChildren(spark(one.p, one.m, 'course of the pressure at 15 °C: ' + one.w[1]));
  if (row.detail) { const fresh = detail(one); row.detail.replaceWith(fresh); row.detail = fresh; }
}
function made(one) {
  const row = put('tr', '', { className: 'row' }), name = put('th', '', { scope: 'row' }), light = put('td', '');
  const open = put('button', one.n, { className: 'open', type: 'button' });
  open.setAttribute('aria-expanded', 'false'); name.append(open); light.append(put('span', ''));
  row.append(light, name, ...one.w.map(() => put('td', '')), put('td', ''));
  [...row.children].forEach((cell, k) => { if (k > 1 && k < labels.length - 1) cell.dataset.l = labels[k]; });
  row.children[6].className = 'due'; drawn.set(one.n, row);
  if (opened.has(one.n)) { row.detail = detail(one); open.setAttribute('aria-expanded', 'true'); }
  fill(row, one);
  row.onclick = () => { const is = opened.delete(one.n); open.setAttribute('aria-expanded', String(!is));
    if (is) { row.detail.remove(); row.detail = null; return; }
    opened.add(one.n); row.detail = detail(fleet.rows.find(other => other.n === one.n)); row.after(row.detail); };
  return row;
}
// Draws the first hits; a row that is there stays the same element.
function draw() {
  const shown = hits.slice(0, until), focus = document.activeElement; let at = body.firstChild;
  const next = element => { if (element === at) at = at.nextSibling; else body.insertBefore(element, at); };
  for (const one of shown) { const row = drawn.get(one.n) || made(one); next(row); if (row.detail) next(row.detail); }
  while (at) { const gone = at; at = at.nextSibling; gone.remove(); }
  if (focus !== document.activeElement && focus.isConnected) focus.focus({ preventScroll: true });
  more.hidden = shown.length === hits.length; more.textContent = 'Show more: ' + (hits.length - shown.length) + ' are left';
}
function choose() {
  const words = find.value.trim().toLowerCase();
  hits = fleet.rows.filter(one => (chosen < 0 || one.l === chosen) && (!words || (one.n + ' ' + one.w.join(' ')).toLowerCase().includes(words)));
  draw(); count.textContent = hits.length + ' of ' + fleet.rows.length + ' cylinders.';
}
buttons.forEach((button, k) => button.onclick = () => { chosen = chosen === k ? -1 : k; until = STEP;
  buttons.forEach((other, j) => other.setAttribute('aria-pressed', String(j === chosen))); choose(); });
find.oninput = () => { until = STEP; choose(); };
more.onclick = () => { until += STEP; draw(); };
document.querySelectorAll('.script').forEach(part => part.classList.remove('script'));
choose();
