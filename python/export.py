"""The program behind `softgrain export`: python3 export.py RUN --to FORMAT (see --help)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
try:
    import h5py  # noqa: F401  needed later, wanted now

    from softgrain.export.__main__ import main
except ImportError as missing:
    print(f"error: {missing}\nexports need NumPy and h5py for {sys.executable}; on Debian:\n"
          "  apt install python3-h5py", file=sys.stderr)
    sys.exit(2)
sys.exit(main())
