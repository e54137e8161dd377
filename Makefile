# Each target installs what it needs of the packages that third_party lists (Debian 12, asks apt-get).
#
# PRESET=debug, ci, clang, asan or tsan chooses another of CMakePresets.json; under asan and tsan, the sanitizers,
# `make test` leaves out the long studies (docs/contributing/testing.md).

PRESET ?= release
JOBS ?= $(shell nproc)
# Not `?=`: make itself has LINT = lint.
LINT =
# A folder is checked as one unit, which has its name.
LINTED := $(if $(LINT),/unity_$(notdir $(LINT:/=))_cxx\.,(core|plugins)/)
BUILD := $(if $(filter release ci,$(PRESET)),build,build-$(PRESET))
SOURCES = $(shell find core plugins examples tests benchmarks -name '*.cpp' -o -name '*.h')

.PHONY: all setup setup-to-develop configure build build-tests benchmarks python deb wheel notebooks demo test golden fuzz extremes data results figures \
        pictures api site format fix-format lint clean
all: build

# Installs what third_party/packages-to-run.txt and packages-to-test.txt list; setup-to-develop also packages-to-develop.txt and
# packages-to-use-clang.txt.
setup:
	@third_party/setup run test $(if $(filter clang asan tsan,$(PRESET)),use-clang)

setup-to-develop:
	@third_party/setup run test develop use-clang

CONFIGURE = cmake --preset $(PRESET) --log-level=WARNING

configure:
	@third_party/setup run
	@$(CONFIGURE) >/dev/null

# The command and its plugins, build/bin/drape, with the Python module where there is one, which loads these libraries.
build: configure
	@cmake --build $(BUILD) -j $(JOBS) --target drape_cli drape_plugins \
	  $$(grep -qx DRAPE_PYTHON:BOOL=ON $(BUILD)/CMakeCache.txt && echo drape_python)

build-tests: setup
	@$(CONFIGURE) -D DRAPE_TESTS=ON >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target drape_tests

# The benchmark programs, build/bin/drape_bench_*.
benchmarks: setup
	@$(CONFIGURE) -D DRAPE_BENCHMARKS=ON >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target drape_cli drape_plugins drape_benchmarks

# The Python module: PYTHONPATH=build/python python3 -c "import drape". `make test` then tests it too.
python: configure
	@third_party/setup use-python
	@$(CONFIGURE) -D DRAPE_PYTHON=ON >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target drape_cli drape_plugins drape_python

# The command, its plugins, the C++ package and the Python module, for Debian 12: build-package/drape_*.deb. Like the wheel it packs
# a build for any processor with AVX2 (the preset `package`).
deb:
	@third_party/setup run use-python
	@cmake --preset package --log-level=WARNING >/dev/null
	@cmake --build build-package -j $(JOBS)
	@cd build-package && cpack >/dev/null && ls $$PWD/drape_*.deb

# The Python module with its libraries, command and plugins, for pip of /usr/bin/python3: build-package/drape-*.whl.
wheel:
	@third_party/setup run use-python
	@CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) /usr/bin/python3 -m pip wheel -q --no-build-isolation --no-deps --no-index -w build-package .
	@ls build-package/drape-*.whl

# Runs the notebooks of docs/guide/notebooks and stores their outputs in them.
notebooks: python setup
	@PYTHONPATH=$(BUILD)/python /usr/bin/python3 tests/python/notebooks.py

# Drapes a square over a sphere by PCS, shows the preview first.
demo: build
	@configs/demo $(BUILD)/bin/drape

# Runs every test.
test: build-tests
	@ctest --preset $(PRESET) -j $(JOBS)

# Writes what the shipped experiments run to now into the record that the tests compare, and shows what changed.
golden: build-tests
	@DRAPE_GOLDEN=1 ctest --preset $(PRESET) -R configs.shipped_configs
	@git diff --stat tests/configs/data

# Fuzzes the readers of configs, --set, meshes, sewing patterns and checkpoints for FUZZ_SECONDS each (20), or FUZZ_RUNS inputs each;
# FUZZ_TARGETS="mesh config" chooses some; what ends one is kept in build-fuzz/artifacts.
fuzz: build
	@third_party/setup run test use-clang
	@cmake --preset fuzz --log-level=WARNING -DDRAPE_BUILD=$(abspath $(BUILD)) >/dev/null
	@cmake --build build-fuzz -j $(JOBS)
	@FUZZ_SECONDS=$(FUZZ_SECONDS) FUZZ_RUNS=$(FUZZ_RUNS) JOBS=$(JOBS) tests/fuzz/run build-fuzz $(FUZZ_TARGETS)

# Small drapes with parameters at their declared bounds: EXTREMES (500) of them, from the seed EXTREMES_SEED (1).
extremes: build setup
	@tests/extremes/run $(BUILD)/bin/drape --count $(or $(EXTREMES),500) --seed $(or $(EXTREMES_SEED),1) --jobs $(JOBS)

# Fetches scanned meshes and makes obstacles of them: data/*.ply (third_party/data/meshes.txt).
data: configure
	@third_party/data/fetch data $(BUILD)

# Runs what the pages state and fills their figures in: about three hours on two idle cores; resumes. STUDIES=sphere,scale chooses
# some, STUDIES=scenes the one that runs only when it is named; LIMIT=no lifts the studies' own limits, which
# `benchmarks/run_studies --help` lists. The records are stamped with the commit that ran, so nothing may differ from it
# (benchmarks/run_studies). Studies that need what is not there are left out: scanned meshes and OpenBLAS, which are downloaded, or
# another program, which counts as a failure only where its study is named.
results: benchmarks
	@$(MAKE) --no-print-directory python
	@third_party/setup compare || true
	@third_party/data/fetch data $(BUILD) || true
	@benchmarks/run_studies $(if $(filter no,$(LIMIT)),--no-limit) $(BUILD) $(STUDIES)

# Fills the pages' figures in from the stored records; runs nothing.
figures:
	@benchmarks/fill_figures

# Pictures of README and docs, from the runs of the study sphere that `make results` has left (FROM=results/studies/COMMIT/ chooses
# the build, the newest otherwise) and from some runs of its own, minutes.
FROM ?= $(patsubst %sphere,%,$(shell ls -td results/studies/*/sphere 2>/dev/null | head -1))
# The start whose PCS preview has the median distance from its final state.
SPHERE = $(FROM)sphere/runs/base/seed_1
pictures: benchmarks data
	@third_party/setup develop
	@[ -e $(SPHERE)/results.json ] || { echo "pictures: no run of the study sphere; make results STUDIES=sphere" >&2; exit 1; }
	@tests/browser/install $(BUILD)/tests/browser
	DRAPE_BIN=$(abspath $(BUILD))/bin DRAPE_NODE_MODULES=$(abspath $(BUILD))/tests/browser node docs/pictures/make.mjs $(SPHERE) results/pictures

# Pages of the headers that plugins include, by Doxygen.
api:
	@third_party/setup develop
	@doxygen docs/Doxyfile
	@echo "build/api/html/index.html"

# The Markdown files as a searchable site, whose links are checked: build/site/html/README.html.
site:
	@third_party/setup develop
	@mkdir -p build/site/pages && ln -sfn $(addprefix $(CURDIR)/,$(filter-out build% results,$(wildcard *))) build/site/pages
	@mkdocs build --strict --quiet
	@echo "build/site/html/README.html"

# Checks the layout of the sources.
format:
	@third_party/setup develop
	@clang-format --dry-run -Werror $(SOURCES)

fix-format:
	@third_party/setup develop
	@clang-format -i $(SOURCES)

# Static analysis of core and plugins, or of one folder (LINT=core/app/sweep), each source checked by itself.
lint:
	@third_party/setup run test use-clang
	@cmake --preset single-files --log-level=ERROR >/dev/null
	@cmake --build build-single-files -j $(JOBS) --target drape_cli drape_plugins
	@cmake --preset lint --log-level=ERROR >/dev/null
	@grep -qE '$(LINTED)' build-lint/compile_commands.json || \
	  { echo "lint: LINT=$(LINT) names no folder with sources of its own; give one such as core/app/sweep or plugins/energy" >&2; exit 2; }
	@run-clang-tidy-16 -quiet -p build-lint -j $(JOBS) -extra-arg=-Wno-ignored-optimization-argument \
	  -extra-arg=-Wno-unused-command-line-argument '$(LINTED)'

# Removes what was built.
clean:
	@[ ! -d build ] || find build/ -mindepth 1 -delete  # build itself may be a mount, as in .devcontainer
	rm -rf build-package build-debug build-clang build-asan build-tsan build-lint build-fuzz build-single-files
