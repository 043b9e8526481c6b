// Opens the cases of a page in the laboratory: those in its blocks of TOML, and those of `cases/` that it
// names. build.sh writes this into a function, after `makeLink` of the laboratory and the names `CASES`.

const LABORATORY = `${path_to_root}lab.html`;

/** An element with its properties and children. */
const make = (name, properties, ...children) => {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
};

/** Below a case, a link to the laboratory and a button that opens it in the page. */
async function offer(code) {
  const name = document.querySelector('main h1')?.textContent ?? 'case';
  const link = await makeLink({ name, toml: code.textContent, files: {} });
  if (link === null) return;
  const href = `${LABORATORY}#case=${link}`;
  const button = make('button', { type: 'button', textContent: 'Try it here' });
  const place = make('div', { className: 'lab' }, button, make('a', { href, target: '_blank', textContent: 'Open in the laboratory' }));
  button.addEventListener('click', () => {
    const shown = place.querySelector('iframe');
    if (shown) shown.remove();
    else place.append(make('iframe', { src: href, title: 'The laboratory with this case' }));
    button.textContent = shown ? 'Try it here' : 'Close the laboratory';
  });
  code.closest('pre').after(place);
}

// Studies, designs and calibrations have a second word after `toml`. The files that a case names are not in
// the page.
for (const code of document.querySelectorAll('main code.language-toml')) {
  const isCase = !['study', 'design', 'calibration', 'ignore'].some((other) => code.classList.contains(other));
  if (isCase && !/^file = /m.test(code.textContent)) offer(code);
}

for (const code of document.querySelectorAll('main :not(pre, h1, h2, h3) > code')) {
  const name = /^cases\/(\w+)\.toml$/.exec(code.textContent)?.[1];
  if (!CASES.includes(name)) continue;
  const title = `${name} in the laboratory`;
  (code.closest('a') ?? code).after(' ', make('a', { href: `${LABORATORY}#preset=${name}`, target: '_blank', title, ariaLabel: title, textContent: '▶' }));
}
