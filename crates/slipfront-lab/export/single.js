// Makes modules of the files within this page, each after those that it imports, and begins.
const files = JSON.parse(document.getElementById('files').textContent);
const made = new Map();
function address(name) {
  if (!made.has(name)) {
    const text = files[name].replace(/(from\s+)'\.\/([\w./-]+)'/g, (_, from, other) => `${from}'${address(other)}'`);
    made.set(name, URL.createObjectURL(new Blob([text], { type: 'text/javascript' })));
  }
  return made.get(name);
}
import(address('main.js'));
