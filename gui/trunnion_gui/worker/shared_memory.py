"""Things on their way between two processes: large arrays travel in one block of shared memory, the rest in the pipe."""

from __future__ import annotations

import copyreg
import io
import pickle
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.shared_memory import SharedMemory
from typing import Any

from trunnion.model.session import Session
from trunnion_gui.worker.session_changes import SharedSession, complete_session

SMALL = 1 << 18
"""Bytes of arrays below which a block of shared memory costs more than it saves."""


@dataclass(frozen=True, slots=True)
class SharedMessage:
    """A pickled thing; its arrays of `sizes` bytes lie one after the other in the shared block, if it has one.

    A reply says by the number of its request which session it leaves things out of.
    """

    data: bytes
    block: str = ""
    sizes: tuple[int, ...] = ()
    number: int = 0


def packed(thing: Any, known: SharedSession | None = None, number: int = 0) -> SharedMessage:
    """Return a thing ready to be sent. The receiver must call `unpacked` once: that frees the block.

    Of a session in it goes only what is not in the `known` one, which the receiver has as well.
    """
    known = known or SharedSession()
    buffers: list[pickle.PickleBuffer] = []
    data = _dumped(thing, known, buffers.append)
    views = [b.raw() for b in buffers]
    sizes = tuple(v.nbytes for v in views)
    if sum(sizes) < SMALL:
        message = SharedMessage(_dumped(thing, known), number=number)
        known.settle()
        return message
    known.settle()
    memory = SharedMemory(create=True, size=sum(sizes))
    buffer, at = memoryview(memory.buf or b""), 0
    for view in views:
        buffer[at : at + view.nbytes] = view
        at += view.nbytes
    buffer.release()
    memory.close()
    return SharedMessage(data, memory.name, sizes, number)


def unpacked(message: SharedMessage, known: SharedSession | None = None) -> Any:
    """Return the thing of a parcel and free its block; arrays come back read-only.

    Raises `ValueError` when a session in it lacks what the `known` one should have.
    """
    known = known or SharedSession()
    buffers = _taken_buffers(message) if message.block else []
    thing = _Unpickler(message.data, buffers, known).load()
    known.settle()
    return thing


def _taken_buffers(message: SharedMessage) -> list[bytes]:
    memory = SharedMemory(name=message.block)
    buffer, buffers, at = memoryview(memory.buf or b""), [], 0
    for size in message.sizes:
        buffers.append(bytes(buffer[at : at + size]))
        at += size
    buffer.release()
    memory.close()
    memory.unlink()
    return buffers


def _dumped(
    thing: Any,
    known: SharedSession,
    take_buffer: Callable[[pickle.PickleBuffer], Any] | None = None,
) -> bytes:
    stream = io.BytesIO()
    pickler = pickle.Pickler(stream, protocol=5, buffer_callback=take_buffer)
    pickler.dispatch_table = copyreg.dispatch_table | {Session: known.reduced}
    pickler.dump(thing)
    return stream.getvalue()


class _Unpickler(pickle.Unpickler):
    """Completes sessions with what the known one has."""

    def __init__(self, data: bytes, buffers: list[bytes], known: SharedSession) -> None:
        super().__init__(io.BytesIO(data), buffers=buffers)
        self._known = known

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) == (complete_session.__module__, complete_session.__name__):
            return self._known.complete
        return super().find_class(module, name)
