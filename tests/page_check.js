// What a reader would see go wrong on this page, one line each: evaluated in the page by page_check.py, which wants
// `charts` charts there.
(charts) => {
  const complaints = [];
  const complain = (element, what) => {
    const words = element.textContent.trim().slice(0, 40) || element.getAttribute('alt') || '';
    complaints.push(`<${element.tagName.toLowerCase()}> "${words}" ${what}`);
  };
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const box = (element) => element.getBoundingClientRect();
  // Both by more than `slack` pixels.
  const overlap = (a, b, slack) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > slack &&
                                   Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > slack;

  const found = all('svg').length;
  if (found !== charts) complaints.push(`${found} charts, not ${charts}`);
  for (const picture of all('svg, img')) {
    const { width, height } = box(picture);
    if (width < 50 || height < 50) complain(picture, `is only ${width} x ${height} pixels`);
    if (picture.naturalWidth === 0) complain(picture, 'has no picture');
  }

  if (document.documentElement.scrollWidth > innerWidth) complaints.push('the page is wider than the window');
  for (const element of all('body *:not(svg *)')) {
    const { left, right } = box(element);
    if (left >= -1 && right <= innerWidth + 1) continue;
    complain(element, `sticks out: ${left} to ${right} of ${innerWidth} pixels`);
  }

  const blocks = all('h1, h2, h3, p, figure, figcaption, table, th, td, img, svg').filter((e) => box(e).width > 0);
  blocks.forEach((a, i) => blocks.slice(i + 1).forEach((b) => {
    if (a.contains(b) || b.contains(a) || !overlap(box(a), box(b), 1)) return;
    complain(a, `overlaps "${b.textContent.trim().slice(0, 40)}"`);
  }));

  for (const svg of all('svg')) {
    const texts = all('text', svg);
    const outer = box(svg);
    texts.forEach((a, i) => {
      const inner = box(a);
      if (inner.left < outer.left - 2 || inner.right > outer.right + 2 || inner.top < outer.top - 2 ||
          inner.bottom > outer.bottom + 2) complain(a, 'sticks out of its chart');
      // The boxes of letters are higher than what is seen of them.
      const slack = 0.25 * Math.min(inner.width, inner.height);
      texts.slice(i + 1).forEach((b) => {
        if (overlap(inner, box(b), slack)) complain(a, `overlaps "${b.textContent}" in its chart`);
      });
    });
  }

  for (const element of all('[src], link[href]')) {
    const asked = element.getAttribute('src') ?? element.getAttribute('href');
    if (!asked.startsWith('data:')) complain(element, `asks for ${asked}`);
  }
  for (const { name } of performance.getEntriesByType('resource')) {
    if (!name.startsWith('data:')) complaints.push(`asks for ${name}`);
  }
  return complaints;
}
