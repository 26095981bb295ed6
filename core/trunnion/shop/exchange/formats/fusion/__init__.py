"""Fusion's tool libraries."""

from trunnion.shop.exchange.formats.fusion.library import FusionFormat as FusionFormat
