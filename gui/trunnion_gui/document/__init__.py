"""What the window is about, by subject: `document` the session with its history, `selection`, `jobs` of the worker, `files` in and out."""

from trunnion_gui.document.document import Document as Document
from trunnion_gui.document.files import PROJECT as PROJECT
from trunnion_gui.document.selection import NOTHING as NOTHING
from trunnion_gui.document.selection import Selection as Selection
