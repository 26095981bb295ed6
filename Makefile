# Everything a person needs: `make demo` programs a real part, `make test` proves the program itself.
PYTHON ?= python3
BIN := .venv/bin
OUT ?= out/demo
export QT_QPA_PLATFORM ?= offscreen
export PYTHONHASHSEED ?= 0
# Two processes of tests fill two cores: threads of numpy would only wait for each other.
export OPENBLAS_NUM_THREADS ?= 1
# Tests start processes by the hundred; without compiled files each would compile all modules anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: packages setup demo test test-long bench screenshots run check lint docs clean wheel deb appimage

# The environment is made anew when the lock or the project file changes.
.venv/made: requirements.lock pyproject.toml | packages
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install -q --disable-pip-version-check -r requirements.lock
	$(BIN)/python -m pip install -q --disable-pip-version-check --no-deps -e .
	$(BIN)/trunnion compile
	touch .venv/made

# Every time, because it takes no time and a machine may have lost a package, or an older checkout may have asked for fewer.
packages:
	@sh installer/debian.sh

setup: packages .venv/made

demo: setup
	$(BIN)/trunnion program $$($(BIN)/python -m trunnion_resources B1) -o $(OUT) --name B1
	@echo "Open $(OUT)/B1.report.html"

lint: setup
	$(BIN)/ruff format --check -q core gui resources tests installer
	$(BIN)/ruff check core gui resources tests installer
	$(BIN)/mypy core/trunnion gui/trunnion_gui
	$(BIN)/mypy installer
	$(BIN)/lint-imports

test: setup lint
	sh installer/rs274.sh
	$(BIN)/python -m pytest -q -m "not long and not display" -n 2 --dist loadfile --no-loadscope-reorder

test-long: setup
	sh installer/debian.sh --display
	sh installer/rs274.sh
	$(BIN)/python -m pytest -q -m "long"
	QT_QPA_PLATFORM=xcb xvfb-run -a -s "-screen 0 1600x1000x24" $(BIN)/python -m pytest -q tests/gui -m "not long"

check: test

bench: setup
	$(BIN)/python tests/bench/run.py --output bench.json

screenshots: setup
	$(BIN)/python -m trunnion_gui.screenshots docs/pictures

run: setup
	env -u QT_QPA_PLATFORM $(BIN)/trunnion-gui

docs: setup
	$(BIN)/trunnion settings --markdown > docs/settings.md
	$(BIN)/python -m pip install -q --disable-pip-version-check "mkdocs-material>=9.6"
	$(BIN)/mkdocs build -q --strict

# The wheel alone, with what it needs by name and range; `pip install` takes it.
wheel: setup
	rm -f dist/*.whl
	$(BIN)/python -m hatchling build -t wheel -d dist

# Installers of this machine's system; docs/installing.md says what they want and what is in them.
deb: wheel
	$(BIN)/python -m installer.deb dist/*.whl

appimage: wheel
	$(BIN)/python -m installer.appimage dist/*.whl $(if $(RUNTIME),--runtime $(RUNTIME))

clean:
	rm -rf out build dist .mypy_cache .ruff_cache .hypothesis bench.json
