"""The look: calm, flat, one accent colour. One style sheet made from a theme's colours."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication

from trunnion_gui.look import icons
from trunnion_gui.look.colours import Theme, mixed

_SHEET = """
* {{ font-size: 13px; }}
QMainWindow, QDialog, QStatusBar, QMenuBar, QToolBar {{ background: {window}; color: {text}; }}
QMainWindow::separator {{ background: {window}; width: 5px; height: 5px; }}
QMainWindow::separator:hover {{ background: {accent_soft}; }}
QMenuBar {{ padding: 2px 6px; }}
QMenuBar::item {{ padding: 4px 9px; border-radius: 4px; background: transparent; }}
QMenuBar::item:selected, QMenu::item:selected {{ background: {accent_soft}; color: {text}; }}
QMenu {{ background: {panel}; color: {text}; border: 1px solid {line}; padding: 5px; }}
QMenu::item {{ padding: 5px 26px 5px 10px; border-radius: 4px; }}
QMenu::item:disabled {{ color: {muted}; }}
QMenu::separator {{ height: 1px; background: {line}; margin: 5px 8px; }}
QToolBar {{ border: none; border-bottom: 1px solid {line}; padding: 4px 8px; spacing: 3px; }}
QToolBar::separator {{ background: {line}; width: 1px; margin: 5px 6px; }}
QToolButton {{ background: transparent; color: {text}; border: none; border-radius: 5px; padding: 5px; }}
QToolButton:hover {{ background: {accent_soft}; }}
QToolButton:checked {{ background: {accent_soft}; }}
QToolButton:disabled {{ color: {muted}; }}
QToolButton#program {{ background: {accent}; color: {accent_text}; padding: 5px 14px 5px 9px; font-weight: 600; }}
QToolButton#program:hover {{ background: {accent_over}; }}
QToolButton#program:disabled {{ background: {line}; color: {muted}; }}
QDockWidget {{ color: {muted}; titlebar-close-icon: none; titlebar-normal-icon: none; font-weight: 600; }}
QDockWidget::title {{ background: {window}; padding: 7px 10px 5px 10px; text-align: left; }}
QDockWidget > QWidget {{ background: {panel}; }}
QTabBar {{ background: {window}; qproperty-drawBase: 0; }}
QTabBar::tab {{ background: transparent; color: {muted}; padding: 6px 13px; border: none; border-bottom: 2px solid transparent; }}
QTabBar::tab:selected {{ color: {text}; border-bottom: 2px solid {accent}; font-weight: 600; }}
QTabBar::tab:hover {{ color: {text}; }}
QTreeView, QTableView, QListView, QPlainTextEdit, QTextEdit {{ background: {panel}; color: {text}; border: none; outline: none;
    selection-background-color: {accent_soft}; selection-color: {text}; alternate-background-color: {raised}; gridline-color: {line}; }}
QTreeView::item, QTableView::item {{ padding: 3px 5px; border: none; }}
QTreeView::item:selected, QTableView::item:selected, QListView::item:selected {{ background: {accent_soft}; color: {text}; }}
QTreeView::item:hover, QTableView::item:hover {{ background: {raised}; }}
QHeaderView {{ background: {panel}; }}
QHeaderView::section {{ background: {panel}; color: {muted}; border: none; border-bottom: 1px solid {line}; padding: 5px 6px;
    font-size: 12px; }}
QHeaderView::up-arrow, QHeaderView::down-arrow {{ subcontrol-position: center left; width: 8px; height: 8px; }}
QTableCornerButton::section {{ background: {panel}; border: none; }}
QScrollArea {{ background: {panel}; border: none; }}
QScrollArea > QWidget > QWidget {{ background: {panel}; }}
QScrollArea#stepsArea, QWidget#steps {{ background: {window}; }}
QScrollBar:vertical {{ background: transparent; width: 10px; margin: 2px; }}
QScrollBar:horizontal {{ background: transparent; height: 10px; margin: 2px; }}
QScrollBar::handle {{ background: {line}; border-radius: 3px; min-height: 28px; min-width: 28px; }}
QScrollBar::handle:hover {{ background: {muted}; }}
QScrollBar::add-line, QScrollBar::sub-line, QScrollBar::add-page, QScrollBar::sub-page {{ background: none; width: 0; height: 0; }}
QLineEdit, QSpinBox, QDoubleSpinBox, QComboBox {{ background: {panel}; color: {text}; border: 1px solid {line}; border-radius: 5px;
    padding: 3px 7px; min-height: 21px; selection-background-color: {accent}; selection-color: {accent_text}; }}
QLineEdit:focus, QSpinBox:focus, QDoubleSpinBox:focus, QComboBox:focus {{ border: 1px solid {accent}; }}
QLineEdit:hover, QSpinBox:hover, QDoubleSpinBox:hover, QComboBox:hover {{ border: 1px solid {muted}; }}
QSpinBox::up-button, QSpinBox::down-button, QDoubleSpinBox::up-button, QDoubleSpinBox::down-button {{ width: 0; border: none; }}
QComboBox::drop-down {{ border: none; width: 20px; }}
QComboBox::down-arrow {{ image: url({icons}/chevron.svg); width: 12px; height: 12px; }}
QComboBox QAbstractItemView {{ background: {panel}; color: {text}; border: 1px solid {line}; padding: 4px; }}
QCheckBox {{ spacing: 7px; color: {text}; }}
QCheckBox::indicator, QTreeView::indicator, QListView::indicator, QTableView::indicator {{
    width: 15px; height: 15px; border: 1px solid {muted}; border-radius: 4px; background: {panel}; }}
QCheckBox::indicator:checked, QTreeView::indicator:checked, QListView::indicator:checked, QTableView::indicator:checked {{
    background: {accent}; border-color: {accent}; image: url({icons}/tick.svg); }}
QPushButton {{ background: {raised}; color: {text}; border: 1px solid {line}; border-radius: 5px; padding: 5px 13px; min-height: 20px; }}
QPushButton:hover {{ border-color: {accent}; }}
QPushButton:disabled {{ color: {muted}; background: {window}; border-color: {line}; }}
QPushButton#primary {{ background: {accent}; color: {accent_text}; border-color: {accent}; font-weight: 600; }}
QPushButton#primary:hover {{ background: {accent_over}; }}
QPushButton#primary:disabled {{ background: {line}; color: {muted}; border-color: {line}; }}
QPushButton#link {{ background: transparent; border: none; color: {accent}; padding: 2px 4px; text-align: left; }}
QPushButton#link:hover {{ text-decoration: underline; }}
QProgressBar {{ background: {line}; border: none; border-radius: 3px; max-height: 6px; }}
QProgressBar::chunk {{ background: {accent}; border-radius: 3px; }}
QStatusBar {{ border-top: 1px solid {line}; }}
QStatusBar::item {{ border: none; }}
QToolTip {{ background: {text}; color: {panel}; border: none; padding: 5px 8px; }}
QLabel {{ color: {text}; background: transparent; }}
QLabel#muted {{ color: {muted}; }}
QLabel#tip {{ background: {text}; color: {panel}; border-radius: 4px; padding: 3px 7px; font-weight: 600; }}
QToolButton#run {{ background: {accent_soft}; padding: 5px 9px; }}
QToolButton#inTable {{ background: {accent_soft}; color: {accent}; padding: 0px 10px; margin: 1px 4px; }}
QToolButton#inTable:hover {{ background: {raised}; }}
QLabel#title {{ font-size: 15px; font-weight: 600; }}
QLabel#welcome {{ font-size: 22px; font-weight: 600; }}
QLabel#number {{ color: {muted}; font-weight: 600; }}
QLabel[verdict="good"] {{ color: {good}; font-weight: 600; }}
QLabel[verdict="warning"] {{ color: {warning}; font-weight: 600; }}
QLabel[verdict="bad"] {{ color: {bad}; font-weight: 600; }}
QFrame#foldout {{ background: {panel}; border: 1px solid {line}; border-radius: 7px; }}
QFrame#foldoutHeader {{ background: transparent; border-radius: 7px; }}
QFrame#foldoutHeader:hover {{ background: {raised}; }}
QFrame#settingsGroup {{ background: transparent; border: none; }}
QFrame#legend, QFrame#card, QFrame#finder {{ background: {panel}; border: 1px solid {line}; border-radius: 8px; }}
QFrame#notice {{ background: {panel}; border: 1px solid {line}; border-radius: 7px; }}
QFrame#notice[severity="error"] {{ border-left: 4px solid {bad}; }}
QFrame#notice[severity="warning"] {{ border-left: 4px solid {warning}; }}
QFrame#notice[severity="info"] {{ border-left: 4px solid {accent}; }}
QFrame#rule {{ background: {line}; border: none; max-height: 1px; min-height: 1px; }}
QPlainTextEdit#code {{ font-family: "JetBrains Mono", "DejaVu Sans Mono", Consolas, Menlo, monospace; font-size: 12px; }}
"""


def sheet(theme: Theme) -> str:
    """Return the style sheet of a theme."""
    names = {name: getattr(theme, name) for name in Theme.__slots__}
    folder = Path(str(files("trunnion_resources") / "icons")).as_posix()
    return _SHEET.format(**names, icons=folder, accent_over=mixed(theme.accent, theme.text, 0.15))


def apply(theme: Theme) -> None:
    """Give the whole program the look of a theme; nothing is drawn anew when it has that already."""
    app = QApplication.instance()
    assert isinstance(app, QApplication)
    icons.use_theme(theme)
    wanted = sheet(theme)
    if app.styleSheet() == wanted:
        return
    palette = QPalette()
    roles = QPalette.ColorRole
    for role, colour in (
        (roles.Window, theme.window),
        (roles.Base, theme.panel),
        (roles.Text, theme.text),
        (roles.WindowText, theme.text),
        (roles.Button, theme.raised),
        (roles.ButtonText, theme.text),
        (roles.Highlight, theme.accent_soft),
        (roles.HighlightedText, theme.text),
        (roles.AlternateBase, theme.raised),
        (roles.PlaceholderText, theme.muted),
        (roles.Link, theme.accent),
        (roles.Accent, theme.accent),
    ):
        palette.setColor(role, QColor(colour))
    for role in (roles.Text, roles.WindowText, roles.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, role, QColor(theme.muted))
    app.setStyle("Fusion")
    app.setPalette(palette)
    app.setStyleSheet(wanted)
