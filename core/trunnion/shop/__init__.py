"""The catalogues: cutters and holders, materials, machines, typical plans; the program's own with the user's folder over them."""

from trunnion.shop.catalogue import Shop as Shop
from trunnion.shop.catalogue import load_shop as load_shop
from trunnion.shop.plans import Stage as Stage
from trunnion.shop.plans import TypicalPlan as TypicalPlan
