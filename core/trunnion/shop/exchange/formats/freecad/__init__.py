"""FreeCAD's tools and libraries."""

from trunnion.shop.exchange.formats.freecad.library import FreeCadFormat as FreeCadFormat
