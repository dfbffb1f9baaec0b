"""The program behind `softgrain reproduce`: python3 reproduce.py all -o DIR (see --help)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
try:
    import h5py  # noqa: F401  needed later, wanted now

    from softgrain.reproduce.__main__ import main
except ImportError as missing:
    print(f"error: {missing}\nfigures need NumPy, Matplotlib and h5py for {sys.executable}; on Debian:\n"
          "  apt install python3-matplotlib python3-h5py", file=sys.stderr)
    sys.exit(2)
sys.exit(main())
