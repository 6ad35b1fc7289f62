"""``python -m porolub``."""

import os

# as in porolub.cli: before anything imports numpy
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

from porolub.cli import main

if __name__ == "__main__":
    main()
