// KaTeX over the formulas that math_in_pages.py left; a block may hold several equations with their numbers.
for (const element of document.querySelectorAll('.math'))
  katex.render(element.textContent, element, { displayMode: element.tagName === 'DIV', throwOnError: false });
