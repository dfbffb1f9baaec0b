"""The program behind `softgrain sweep`: python3 sweep.py CASE --vary KEY=VALUES -o DIR (see --help)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
try:
    from softgrain.sweep.__main__ import main
except ImportError as missing:
    print(f"error: {missing}\nsweeps need NumPy for {sys.executable}, and Matplotlib and h5py for the figure; on Debian:\n"
          "  apt install python3-matplotlib python3-h5py", file=sys.stderr)
    sys.exit(2)
sys.exit(main())
