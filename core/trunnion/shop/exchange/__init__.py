"""Tool libraries of other programs, read and written, each with the list of what was lost on the way."""

from trunnion.shop.exchange.contract import ExchangeContext as ExchangeContext
from trunnion.shop.exchange.contract import Loss as Loss
from trunnion.shop.exchange.contract import LossKind as LossKind
from trunnion.shop.exchange.contract import ReadTools as ReadTools
from trunnion.shop.exchange.contract import ToolFormat as ToolFormat
from trunnion.shop.exchange.contract import WrittenTools as WrittenTools
from trunnion.shop.exchange.contract import findings_of as findings_of
from trunnion.shop.exchange.contract import format_of as format_of
