"""The plan library: plans taught by finished parts, kept in a database of the user's folder and found again for similar parts."""

from trunnion.shop.library.plan_library import PlanLibrary as PlanLibrary
from trunnion.shop.library.plan_library import PlanMatch as PlanMatch
from trunnion.shop.library.plan_library import library_file as library_file
from trunnion.shop.library.signature import PartSignature as PartSignature
from trunnion.shop.library.similarity import Similarity as Similarity
from trunnion.shop.library.similarity import similarity as similarity
from trunnion.shop.library.taught_plan import TaughtOperation as TaughtOperation
from trunnion.shop.library.taught_plan import TaughtPlan as TaughtPlan
