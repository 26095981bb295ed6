"""Where installed programs keep compiled kernels: in a folder below `NUMBA_CACHE_DIR`, under the module's name.

numba's own locators name that folder after the source file's path, and leave out kernels that lie where nobody may write. An AppImage
is mounted at another path each time it is started, and a package's files belong to root; the module's name is the same for all of them.
What a file in the cache was compiled from is checked by numba: the digest of the source file, the processor, the types.

`NUMBA_CACHE_LOCATOR_CLASSES` names the class, before numba's own for the kernels of other packages
(numba's documentation, "Environment variables: Caching options").
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba import config
from numba.core.caching import UserProvidedCacheLocator


class ModuleCacheLocator(UserProvidedCacheLocator):
    """Caches the kernels of Trunnion in the folder `NUMBA_CACHE_DIR`/MODULE, wherever their source lies."""

    def __init__(self, py_func: Callable[..., Any], py_file: str) -> None:
        super().__init__(py_func, py_file)
        self._cache_path = str(Path(config.CACHE_DIR) / py_func.__module__)

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> ModuleCacheLocator | None:
        """Return the locator of a kernel; None for another package's, and where no writable folder is named."""
        if py_func.__module__.partition(".")[0] != "trunnion":
            return None
        return super().from_function(py_func, py_file)
