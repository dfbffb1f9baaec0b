"""How every figure looks and is saved: print sizes, type, colours; a file depends on the data alone."""

import hashlib
from contextlib import contextmanager

import matplotlib
from cycler import cycler

MM = 1 / 25.4  # one millimetre in inches
SINGLE_COLUMN, DOUBLE_COLUMN = 85, 180  # [mm]
POINT = 25.4 / 72  # one typographic point [mm]

# Okabe and Ito's colours, apart also for colour-blind eyes; the yellow is too light for a line on white.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
)
RUN_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
INK, GREY, PALE = "#222222", "#777777", "#E4E4E4"

# STIX comes with matplotlib itself: the same letters, text and mathematics, on every machine.
STYLE = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "axes.titley": 1.0,  # no figure has a title above its axes; to look for a place for one costs a quarter of the drawing
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "axes.linewidth": 0.6,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "xtick.top": True,
    "ytick.right": True,
    "lines.linewidth": 1.0,
    "axes.prop_cycle": cycler(color=RUN_COLOURS),
    "figure.constrained_layout.h_pad": 0.02,
    "figure.constrained_layout.w_pad": 0.02,
    "pdf.fonttype": 42,
    "svg.hashsalt": "softgrain",
}


def millimetres(figure, left, right, bottom, top, **gaps):
    """Fixed margins. A layout that looks at every word costs more than the drawing itself."""
    width, height = figure.get_size_inches() / MM
    figure.subplots_adjust(left / width, bottom / height, 1 - right / width, 1 - top / height, **gaps)


@contextmanager
def style():
    """What is drawn and saved inside has the style of the package; the caller's settings come back after."""
    with matplotlib.rc_context({**matplotlib.rcParamsDefault, **STYLE}):
        yield


def save(figure, path, runs, dpi=300):
    """Writes the figure; where its data come from stands in the file's metadata."""
    made_by, source = provenance(runs)
    metadata = {
        ".png": {"Software": made_by, "Source": source},
        ".svg": {"Creator": made_by, "Source": source, "Date": None},
        ".pdf": {"Creator": made_by, "Subject": source, "Producer": None, "CreationDate": None},
    }
    compression = {"pil_kwargs": {"compress_level": 3}} if path.suffix == ".png" else {}  # 6 takes twice the time for 1 %
    figure.savefig(path, dpi=dpi, metadata=metadata[path.suffix], **compression)


def provenance(runs):
    """(program, source): which softgrain computed the runs, and the SHA-256 of each case."""
    programs = [run.info.get("program", {}) for run in runs]
    builds = {f"softgrain {p.get('version', 'unknown')} ({p.get('commit', 'unknown')})" for p in programs}
    cases = (hashlib.sha256((run.path / "case.toml").read_bytes()).hexdigest()[:16] for run in runs)
    sources = (f"{run.name}: case sha256 {digest}" for run, digest in zip(runs, cases))
    return ", ".join(sorted(builds)), "; ".join(sources)
