"""The stock engine: what is left of the blank, and what the cutter does on the way."""

from __future__ import annotations

from trunnion.verify.stock.run import StockRun, run_stock
from trunnion.verify.stock.stock import Stock

__all__ = ["Stock", "StockRun", "run_stock"]
