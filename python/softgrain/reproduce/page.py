"""The whole reproduction as one HTML page that asks nothing of the network: pictures are inside it."""

import base64
from html import escape
from pathlib import Path

from . import causes

COLOURS = {causes.AS_STATED: "#009E73", causes.OPEN: "#D55E00", causes.ARITHMETIC: "#777777"}
OTHER = "#0072B2"

STYLE = """
:root { color-scheme: light dark; --ink: #222; --ground: #fff; --line: #ccc; --soft: #f5f5f5 }
@media (prefers-color-scheme: dark) { :root { --ink: #ddd; --ground: #181818; --line: #444; --soft: #222 } }
body { font: 16px/1.5 Georgia, serif; color: var(--ink); background: var(--ground); max-width: 62rem; margin: 2rem auto; padding: 0 1rem }
h1, h2 { font-weight: normal; line-height: 1.2 } h2 { margin-top: 2.5rem }
figure { margin: 1.5rem 0 } img { width: 100%; background: #fff } figcaption { font-size: .9rem }
.table { overflow-x: auto } table { border-collapse: collapse; font-size: .85rem; min-width: 46rem }
td, th { border-bottom: 1px solid var(--line); padding: .35rem .5rem; text-align: left; vertical-align: top }
th { position: sticky; top: 0; background: var(--ground) }
.cause { display: inline-block; color: #fff; padding: 0 .4rem; border-radius: .2rem; font-size: .8rem }
.bar { display: flex; height: 1.6rem; margin: 1rem 0 } .bar span { color: #fff; text-align: center; font-size: .85rem; overflow: hidden } .bar span + span { border-left: 1px solid var(--ground) }
code { font-size: .8rem; overflow-wrap: anywhere } li { margin: .4rem 0 } dt { font-weight: bold } dd { margin: 0 0 .5rem 1rem }
a { color: inherit }
"""

CAPTIONS = {
    "fig1": "Fig. 1. Stress on one grain over its strain: a bonded grain (each sample a line), elastic grains, and closed forms.",
    "fig2": "Fig. 2. Stress of the packings over strain from the reference state Phi = 0.8. Lines are means over the samples, bands "
            "span them.",
    "fig3": "Fig. 3. Coordination number; its early half for three rules of contact; packing fraction of the deformed grains.",
    "fig4": "Fig. 4. Scaled coordination number over packing fraction, of the paper's wall and of a slow one.",
}


def write(found, paths, folder, facts):
    """reproduction.html: figures, statements, pictures and provenance. `facts`: {name: words}. Returns its path."""
    figures = [path for path in paths if path.stem in CAPTIONS]
    pictures = [path for path in paths if path.stem not in CAPTIONS]
    parts = ["<h1>Modelling soft granular materials, reproduced</h1>",
             "<p>The figures of S. Nezamabadi et al., <i>Modelling soft granular materials</i>, Powders &amp; Grains 2017, made "
             "again by <code>softgrain reproduce</code>, and each of the paper's statements held against them.</p>",
             f"<p><b>{escape(causes.headline(found))}.</b></p>", _bar(found),
             *(_figure(path, CAPTIONS[path.stem]) for path in figures),
             "<h2>Statement by statement</h2>", _table(found), _commands(found)]
    if pictures:
        parts += ["<h2>The packings</h2>", *(_figure(path, f"{path.stem}: mean pressure in each grain.") for path in pictures)]
    parts += ["<h2>Where it comes from</h2>", _facts(facts)]
    path = Path(folder) / "reproduction.html"
    path.write_text("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                    "<link rel=\"icon\" href=\"data:,\">\n<title>Modelling soft granular materials, reproduced</title>\n"
                    f"<style>{STYLE}</style>\n</head>\n<body data-drawn>\n" + "\n".join(parts) + "\n</body>\n</html>\n", encoding="utf-8")
    return path


def _colour(cause):
    return COLOURS.get(cause, OTHER)


def _bar(found):
    spans = (f'<span style="flex: {number}; background: {_colour(cause)}" title="{escape(cause)}">{number}</span>'
             for cause, number in causes.counts(found).items())
    return f'<div class="bar">{"".join(spans)}</div>'


def _figure(path, caption):
    data = base64.b64encode(path.read_bytes()).decode()
    return (f'<figure><img alt="{escape(path.stem)}" src="data:image/png;base64,{data}">'
            f"<figcaption>{escape(caption)}</figcaption></figure>")


def _runs(found):
    return list(dict.fromkeys(verdict.run for verdict in found if verdict.run))


def _table(found):
    runs = _runs(found)
    rows = []
    for verdict in found:
        badge = f'<span class="cause" style="background: {_colour(verdict.cause)}">{escape(verdict.cause)}</span>'
        run = f'<a href="#run{runs.index(verdict.run) + 1}">{runs.index(verdict.run) + 1}</a>' if verdict.run else ""
        cells = (escape(verdict.figure), escape(verdict.statement), escape(verdict.ours), f"{badge} {escape(verdict.shown)}", run)
        rows.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    head = "".join(f"<th>{word}</th>" for word in ("Fig.", "the paper", "here, by its recipe", "cause, and what shows it", "run"))
    return f'<div class="table"><table><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'


def _commands(found):
    items = (f'<li id="run{number}"><code>{escape(run)}</code></li>' for number, run in enumerate(_runs(found), 1))
    return f"<p>The runs that show the causes:</p><ol>{''.join(items)}</ol>"


def _facts(facts):
    return "<dl>" + "".join(f"<dt>{escape(name)}</dt><dd>{escape(str(words))}</dd>" for name, words in facts.items()) + "</dl>"
