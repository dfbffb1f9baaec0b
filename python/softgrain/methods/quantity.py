"""Numbers as a paper writes them."""

PREFIXES = (("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9))


def quantity(value, unit) -> str:
    """Four digits with a prefix: 0.005, "m" -> "5 mm"."""
    prefix, factor = next(((p, f) for p, f in PREFIXES if abs(value) >= 0.9995 * f), PREFIXES[-1]) if value else ("", 1)
    return f"{value / factor:.4g} {prefix}{unit}".strip()
