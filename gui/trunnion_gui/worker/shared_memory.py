"""Things on their way between two processes: large arrays travel in one block of shared memory, the rest in the pipe."""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from multiprocessing.shared_memory import SharedMemory
from typing import Any

SMALL = 1 << 18
"""Bytes of arrays below which a block of shared memory costs more than it saves."""


@dataclass(frozen=True, slots=True)
class SharedMessage:
    """A pickled thing; its arrays of `sizes` bytes lie one after the other in the shared block, if it has one."""

    data: bytes
    block: str = ""
    sizes: tuple[int, ...] = ()


def packed(thing: Any) -> SharedMessage:
    """Return a thing ready to be sent. The receiver must call `unpacked` once: that frees the block."""
    buffers: list[pickle.PickleBuffer] = []
    data = pickle.dumps(thing, protocol=5, buffer_callback=buffers.append)
    views = [b.raw() for b in buffers]
    sizes = tuple(v.nbytes for v in views)
    if sum(sizes) < SMALL:
        return SharedMessage(pickle.dumps(thing, protocol=5))
    memory = SharedMemory(create=True, size=sum(sizes))
    buffer, at = memoryview(memory.buf or b""), 0
    for view in views:
        buffer[at : at + view.nbytes] = view
        at += view.nbytes
    buffer.release()
    memory.close()
    return SharedMessage(data, memory.name, sizes)


def unpacked(message: SharedMessage) -> Any:
    """Return the thing of a parcel and free its block; arrays come back read-only."""
    if not message.block:
        return pickle.loads(message.data)
    memory = SharedMemory(name=message.block)
    buffer, buffers, at = memoryview(memory.buf or b""), [], 0
    for size in message.sizes:
        buffers.append(bytes(buffer[at : at + size]))
        at += size
    buffer.release()
    memory.close()
    memory.unlink()
    return pickle.loads(message.data, buffers=buffers)
