// Fresh rows from the server; the page stays as it is while there are none.
const link = document.getElementById('link'), rows = new Map(fleet.rows.map(one => [one.n, one]));
// After so many seconds without a word the connection counts as lost, and is made anew.
const SILENT = 15, AGAIN = 5;
let version = fleet.version, events = null, heard = Date.now(), lost = null, called = 0, age = null, came = 0, amiss = [];
const far = time => time === null ? Infinity : time;
function before(a, b) {
  for (let k = 0; k < 4; k++) { const x = far(a.u[k]), y = far(b.u[k]); if (x !== y) return x < y ? -1 : 1; }
  return a.n < b.n ? -1 : 1;
}
function take(fresh) {
  fresh.forEach(one => rows.set(one.n, one));
  fleet.rows = [...rows.values()].sort(before);
  lights.forEach((word, k) => buttons[k].textContent = word + ' ' + fleet.rows.filter(one => one.l === k).length);
  fresh.forEach(one => { const row = drawn.get(one.n); if (row) fill(row, one); });
  document.title = 'Fleet of ' + fleet.rows.length + (fleet.rows.length === 1 ? ' cylinder' : ' cylinders');
  document.querySelector('h1').textContent = document.title;
  choose();
}
const ago = s => s < 120 ? Math.round(s) + ' s' : s < 7200 ? Math.round(s / 60) + ' min' : s < 172800 ? Math.round(s / 3600) + ' h' : Math.round(s / 86400) + ' d';
function tell() {
  const since = (Date.now() - heard) / 1000, words = [];
  if (lost === null && since > SILENT) { lost = heard; events.close(); connect(); }
  if (lost !== null) words.push('Connection to the gateway lost ' + ago((Date.now() - lost) / 1000) + ' ago: what stands here is of '
    + new Date(lost).toLocaleTimeString() + '. It is tried again.');
  else words.push('Connected to the gateway.', ...amiss);
  if (age !== null) words.push('Newest row: ' + ago(age + since) + ' old.');
  else if (lost === null) words.push(came ? 'The times of the rows are ahead of the gateway\'s clock.' : 'No row has come since the gateway started.');
  const text = words.join(' ');
  if (link.textContent !== text) link.textContent = text;
  link.className = 'link' + (lost !== null || amiss.length ? ' amiss' : '');
  if (lost !== null && events.readyState === EventSource.CLOSED && Date.now() - called > 1000 * AGAIN) connect();
}
function connect() {
  called = Date.now();
  events = new EventSource('events?after=' + encodeURIComponent(version));
  const on = (name, act) => events.addEventListener(name, event => { heard = Date.now(); lost = null;
    if (event.lastEventId) version = event.lastEventId; act(JSON.parse(event.data)); });
  on('rows', take);
  on('all', fresh => { rows.clear(); drawn.clear(); body.replaceChildren(); take(fresh); });
  on('state', state => { age = state.age_s; came = state.rows; amiss = state.amiss; tell(); });
  events.onerror = () => { if (lost === null) lost = heard; tell(); };
}
setInterval(tell, 1000);
connect();
