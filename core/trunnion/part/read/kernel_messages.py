"""Keeps the CAD kernel from writing on the terminal; what matters comes back as findings."""

from __future__ import annotations

from OCP.Message import Message, Message_Gravity


def hush() -> None:
    """Let the kernel's messenger print nothing."""
    for printer in Message.DefaultMessenger_s().Printers():
        printer.SetTraceLevel(Message_Gravity.Message_Fail)
