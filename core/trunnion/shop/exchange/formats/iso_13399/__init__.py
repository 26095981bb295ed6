"""Cutting tools after ISO 13399."""

from trunnion.shop.exchange.formats.iso_13399.library import IsoToolFormat as IsoToolFormat
