// Search in the reference: hides the commands, functions and colours that do not have all words of the query. Those whose name begins
// with the query need no other word.
const search = document.getElementById('search');
const none = document.getElementById('none');
const folded = (text) => text.toLowerCase();
const entries = [...document.querySelectorAll('section, .colours span, .swatches figure, #functions + p + table tr')].map((element) => ({
  element,
  name: folded(element.id || element.textContent.trim()),
  text: folded(element.textContent),
}));
const titles = [...document.querySelectorAll('main > h1, main > h2, main > p:not(#none), main > ol, main > nav, #functions + p + table, .colours, .swatches')];

function find() {
  const query = folded(search.value.trim());
  const words = query.split(/\s+/);
  const named = query !== '' && entries.some(({ name }) => name === query);
  let shown = 0;
  for (const { element, name, text } of entries) {
    const found = named ? name.startsWith(query) : words.every((word) => text.includes(word));
    element.hidden = !found;
    shown += found;
  }
  // Titles would stand alone above what is left.
  for (const title of titles) {
    title.hidden = query !== '' && ![...title.children].some((child) => !child.hidden && child.matches('span, tbody, figure'));
  }
  none.hidden = shown > 0;
}

search.addEventListener('input', find);
addEventListener('keydown', (event) => {
  if (event.key === '/' && event.target !== search) {
    event.preventDefault();
    search.focus();
  }
});
