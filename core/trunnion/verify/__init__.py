"""The proof: what a program does to the part and to the blank, judged from its motions alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from trunnion.verify.judge.verdict import prove as prove

__all__ = ["prove"]


def __getattr__(name: str) -> Any:
    # The compiled loops are heavy to import; settings and help must not wait for them.
    if name == "prove":
        from trunnion.verify.judge.verdict import prove

        return prove
    raise AttributeError(f"module {__name__} has no attribute {name}")
