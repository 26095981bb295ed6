"""Trunnion: from the CAD model of an aerospace part to a proven NC program."""

import os

from trunnion.version import __version__ as __version__

# Linear algebra is of small matrices here, thousands of them: threads of its library would only wait for each other, at full load. Our own
# threads and processes keep all cores at work. It is read when numpy is first imported, which comes after this.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
