# make          install what is needed, configure, build the command and its plugins: build/bin/drape
# make setup    install what third_party/packages-to-run.txt and packages-to-test.txt list (Debian 12, asks apt-get); each
#               target installs what it needs of them
# make demo     build the command and its plugins, drape a square over a sphere by PCS, show the preview first
# make results  run what the pages state and fill their figures in, with all that studies need: the Python module, scanned meshes,
#               Blender, OpenBLAS; at most eight hours on two cores; resumes; STUDIES=sphere,scale chooses some, STUDIES=scenes
#               one that takes hours
# make figures  fill the pages' figures in from the stored records; runs nothing
# make python   build the Python module: PYTHONPATH=build/python python3 -c "import drape"; `make test` then tests it too
# make deb      pack the command, its plugins, the C++ package and the Python module: build-package/drape_*.deb, for Debian 12
# make wheel    pack the Python module with its libraries, command and plugins: build-package/drape-*.whl, for pip of /usr/bin/python3
# make notebooks run the notebooks of docs/guide/notebooks and store their outputs in them
# make test     build and run every test
# make fuzz     fuzz the readers of configs, --set, meshes and checkpoints for FUZZ_SECONDS each (20), or FUZZ_RUNS inputs each;
#               FUZZ_TARGETS="mesh config" chooses some; what ends one is kept in build-fuzz/artifacts
# make extremes run small drapes with parameters at their declared bounds: EXTREMES (500) of them, from the seed EXTREMES_SEED (1)
# make data     fetch scanned meshes and make obstacles of them: data/*.ply (third_party/data/meshes.txt)
# make benchmarks build the benchmark programs, build/bin/drape_bench_*
# make pictures the pictures of README and docs, from the runs of the study sphere that `make results` has left (FROM=
#               results/studies/COMMIT/ chooses the build, the newest otherwise) and from some runs of its own, minutes
# make api      pages of the headers that plugins include, by Doxygen: build/api/html/index.html
# make format   check the layout of the sources;  make fix-format  rewrites them
# make lint     static analysis of core and plugins, or of one folder (LINT=core/app/sweep), each source checked by itself
# make clean    remove what was built
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

.PHONY: all setup configure build build-tests benchmarks python deb wheel notebooks demo test fuzz extremes data results figures pictures \
        api format fix-format lint clean
all: build

setup:
	@third_party/setup run test

CONFIGURE = cmake --preset $(PRESET) --log-level=WARNING

configure:
	@third_party/setup run
	@$(CONFIGURE) >/dev/null

# With the Python module where there is one, which loads these libraries.
build: configure
	@cmake --build $(BUILD) -j $(JOBS) --target drape_cli drape_plugins \
	  $$(grep -qx DRAPE_PYTHON:BOOL=ON $(BUILD)/CMakeCache.txt && echo drape_python)

build-tests: setup
	@$(CONFIGURE) -D DRAPE_TESTS=ON >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target drape_tests

benchmarks: setup
	@$(CONFIGURE) -D DRAPE_BENCHMARKS=ON >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target drape_cli drape_plugins drape_benchmarks

python: configure
	@third_party/setup use-python
	@$(CONFIGURE) -D DRAPE_PYTHON=ON >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target drape_cli drape_plugins drape_python

# Both pack one build, for any processor with AVX2 (the preset `package`).
deb:
	@third_party/setup run use-python
	@cmake --preset package --log-level=WARNING >/dev/null
	@cmake --build build-package -j $(JOBS)
	@cd build-package && cpack >/dev/null && ls $$PWD/drape_*.deb

wheel:
	@third_party/setup run use-python
	@CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) /usr/bin/python3 -m pip wheel -q --no-build-isolation --no-deps --no-index -w build-package .
	@ls build-package/drape-*.whl

notebooks: python setup
	@PYTHONPATH=$(BUILD)/python /usr/bin/python3 tests/python/notebooks.py

demo: build
	@configs/demo $(BUILD)/bin/drape

test: build-tests
	@ctest --preset $(PRESET) -j $(JOBS)

fuzz: build setup
	@cmake --preset fuzz --log-level=WARNING -DDRAPE_BUILD=$(abspath $(BUILD)) >/dev/null
	@cmake --build build-fuzz -j $(JOBS)
	@FUZZ_SECONDS=$(FUZZ_SECONDS) FUZZ_RUNS=$(FUZZ_RUNS) JOBS=$(JOBS) tests/fuzz/run build-fuzz $(FUZZ_TARGETS)

extremes: build setup
	@tests/extremes/run $(BUILD)/bin/drape --count $(or $(EXTREMES),500) --seed $(or $(EXTREMES_SEED),1) --jobs $(JOBS)

data: configure
	@third_party/data/fetch data $(BUILD)

# The records are stamped with the commit that ran, so nothing may differ from it (benchmarks/run_studies). Without the scanned
# meshes, Blender or OpenBLAS, which are downloaded, only the studies that need them are left out.
results: benchmarks python
	@third_party/setup compare || true
	@third_party/data/fetch data $(BUILD) || true
	@benchmarks/run_studies $(BUILD) $(STUDIES)

figures:
	@benchmarks/fill_figures

FROM ?= $(patsubst %sphere,%,$(shell ls -td results/studies/*/sphere 2>/dev/null | head -1))
# The start whose PCS preview has the median distance from its final state.
SPHERE = $(FROM)sphere/runs/base/seed_1
pictures: benchmarks data
	@[ -e $(SPHERE)/results.json ] || { echo "pictures: no run of the study sphere; make results STUDIES=sphere" >&2; exit 1; }
	@tests/browser/install $(BUILD)/tests/browser
	DRAPE_BIN=$(abspath $(BUILD))/bin DRAPE_NODE_MODULES=$(abspath $(BUILD))/tests/browser node docs/pictures/make.mjs $(SPHERE) results/pictures

api: setup
	@doxygen docs/Doxyfile
	@echo "build/api/html/index.html"

format: setup
	@clang-format --dry-run -Werror $(SOURCES)

fix-format: setup
	@clang-format -i $(SOURCES)

lint: setup
	@cmake --preset single-files --log-level=ERROR >/dev/null
	@cmake --build build-single-files -j $(JOBS) --target drape_cli drape_plugins
	@cmake --preset lint --log-level=ERROR >/dev/null
	@grep -qE '$(LINTED)' build-lint/compile_commands.json || \
	  { echo "lint: LINT=$(LINT) names no folder with sources of its own; give one such as core/app/sweep or plugins/energy" >&2; exit 2; }
	@run-clang-tidy-16 -quiet -p build-lint -j $(JOBS) -extra-arg=-Wno-ignored-optimization-argument \
	  -extra-arg=-Wno-unused-command-line-argument '$(LINTED)'

clean:
	rm -rf build build-package build-debug build-clang build-asan build-tsan build-lint build-fuzz build-single-files
