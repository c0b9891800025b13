# make map    set up, then map the basement, score it against its truth and plan two paths on it
# make test   set up, then format, lint, types, import contracts and tests: what .ci/run calls
# make fix    format and mend what the linter can mend      make lock   pin the dependencies anew
# make bench  [ONLY=part] measure, print, write build/bench.json      make docs   build/site
#                                                         make clean   forget everything made

PYTHON ?= python3
BIN := .venv/bin
RECORDING ?= datasets/flynn_basement
OUT ?= build/map

.PHONY: map test browser docs fix bench lock clean

map: .venv/ready
	$(BIN)/roomsketch merge $(RECORDING) --out $(OUT)
	$(BIN)/roomsketch score $(OUT) --truth $(RECORDING)/truth.geojson --poses $(RECORDING)/true.tum

test: .venv/ready browser
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -n 2

# The page is tested in a real browser: Debian's where root may install it, else one that playwright fetches.
browser: .venv/ready
	@command -v chromium >/dev/null \
	    || { [ "$$(id -u)" = 0 ] && apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium >/dev/null; } \
	    || $(BIN)/playwright install chromium \
	    || echo "no chromium, and none could be fetched: the tests of the page will be skipped"

fix: .venv/ready
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

bench: .venv/ready
	$(BIN)/python -m tests.benchmarks $(ONLY)

# The figures of the paper's story are made anew each time; the site is build/site/index.html.
docs: .venv/ready
	$(BIN)/roomsketch merge datasets/flynn_basement --out build/basement
	rm -rf docs/pages/figures && cp -r build/basement/figures docs/pages/figures
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet --config-file docs/mkdocs.yml --site-dir ../build/site

# The lock keeps its pins unless UPGRADE=1; it serves every Python and platform of pyproject.toml and names no index.
lock: .venv/ready
	$(BIN)/python -m pip install --quiet uv
	$(BIN)/uv pip compile --no-config --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
	    --no-annotate --custom-compile-command "make lock" --extra dev $(if $(UPGRADE),--upgrade) \
	    --quiet --output-file requirements.lock pyproject.toml

clean:
	rm -rf .venv build *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# Hashes bind every wheel; setuptools comes out of the lock too, so the build needs no second, unpinned download.
.venv/ready: requirements.lock pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	$(BIN)/roomsketch doctor --install
	touch $@
