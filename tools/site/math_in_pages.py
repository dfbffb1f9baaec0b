"""MkDocs hook: GitHub's mathematics, $...$ and ```math blocks, kept from Markdown and handed to KaTeX."""
import html
import re

MATH = re.compile(r"^```math\n(?P<block>.*?)^```$|(?P<code>^```.*?^```$|`[^`\n]+`)|\$(?P<inline>[^$\n]+(?:\n[^$\n]+)?)\$",
                  re.M | re.S)
_formulas = []


def on_page_markdown(markdown, **_):
    _formulas.clear()

    def keep(found):
        if found["code"]:
            return found[0]
        block = found["block"] is not None
        tag = "div" if block else "span"
        formula = html.escape(found["block"] if block else found["inline"])
        _formulas.append(f'<{tag} class="math">{formula}</{tag}>')
        token = f"FORMULA{len(_formulas) - 1}END"
        return f"\n\n{token}\n\n" if block else token

    return MATH.sub(keep, markdown)


def on_page_content(content, **_):
    return re.sub(r"(<p>)?FORMULA(\d+)END(</p>)?", put_back, content)


def put_back(found):
    formula = _formulas[int(found[2])]
    if formula.startswith("<div"):
        return formula
    return (found[1] or "") + formula + (found[3] or "")
