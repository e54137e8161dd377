# make          install what is needed, configure, build the command and its plugins: build/bin/drape
# make setup    install what third_party/packages-to-run.txt and packages-to-test.txt list (Debian 12, asks apt-get); each
#               target installs what it needs of them
# make demo     build the command and its plugins, drape a square over a sphere by PCS, show the preview first
# make results  run what the pages state and fill their figures in, at most eight hours on two cores; resumes; STUDIES=sphere,scale chooses
#               some
# make figures  fill the pages' figures in from the stored records; runs nothing
# make table1   the study of the supplement's Table 1; LEVELS=2 goes to at most so many levels, and writes
#               no record
# make scenes   the study of every scene of the supplement's Table 2 by PCS, many hours (`make data`); LEVELS=2 goes to at most
#               so many, and writes no record
# make python   build the Python module: PYTHONPATH=build/python python3 -c "import drape"; `make test` then tests it too
# make deb      pack the command, its plugins, the C++ package and the Python module: build-package/drape_*.deb, for Debian 12
# make wheel    pack the Python module with its libraries, command and plugins: build-package/drape-*.whl, for pip of /usr/bin/python3
# make notebooks run the notebooks of docs/guide/notebooks and store their outputs in them
# make test     build and run every test
# make fuzz     fuzz the readers of configs, --set, meshes and checkpoints for FUZZ_SECONDS each (20), or FUZZ_RUNS inputs each;
#               FUZZ_TARGETS="mesh config" chooses some; what ends one is kept in build-fuzz/artifacts
# make extremes run small drapes with parameters at their declared bounds: EXTREMES (500) of them, from the seed EXTREMES_SEED (1)
# make data     fetch scanned meshes and make obstacles of them: data/*.ply (third_party/data/meshes.txt)
# make bench    build and run the benchmark programs, to results/*.json; benchmarks alone builds them
# make hard     the study of the hard cases (docs/results/hard-cases.md)
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

.PHONY: all setup configure build build-tests benchmarks python deb wheel notebooks demo table1 scenes test fuzz extremes data bench hard results figures \
        pictures api format fix-format lint clean
all: build

setup:
	@third_party/setup run test

# A build folder begins without tests and benchmarks, whose packages running does not need, and has them from the first
# target on that asks for them.
CONFIGURE = cmake --preset $(PRESET) --log-level=WARNING \
            $$([ -e $(BUILD)/CMakeCache.txt ] || echo -D DRAPE_TESTS=OFF -D DRAPE_BENCHMARKS=OFF)

configure:
	@third_party/setup run
	@$(CONFIGURE) >/dev/null

build: configure
	@cmake --build $(BUILD) -j $(JOBS) --target drape_cli drape_plugins

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
	@/usr/bin/python3 -m pip wheel -q --no-build-isolation --no-deps --no-index -w build-package .
	@ls build-package/drape-*.whl

notebooks: python setup
	@PYTHONPATH=$(BUILD)/python /usr/bin/python3 tests/python/notebooks.py

demo: build
	@configs/demo $(BUILD)/bin/drape

# Whole studies are those of `make results`; a part of one stays in results/.
to_levels = $(BUILD)/bin/drape sweep configs/sweeps/$(1).yaml --out results/$(1)_levels_$(LEVELS) --most-levels $(LEVELS)
table1: benchmarks
	@$(if $(LEVELS),$(call to_levels,table1); benchmarks/table1 results/table1_levels_$(LEVELS),benchmarks/run_studies --no-limit $(BUILD) table1)

scenes: benchmarks
	@$(if $(LEVELS),$(call to_levels,scenes); $(BUILD)/bin/drape table results/scenes_levels_$(LEVELS),benchmarks/run_studies --no-limit $(BUILD) scenes)

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

bench: benchmarks
	mkdir -p results
	$(BUILD)/bin/drape_bench_kernels --benchmark_out=results/kernels.json --benchmark_out_format=json
	$(BUILD)/bin/drape_bench_linear_solvers results/linear_solvers.json
	$(BUILD)/bin/drape_bench_ratios results/ratios.json
	$(BUILD)/bin/drape_bench_changes results/changes.json

hard: benchmarks
	@benchmarks/run_studies $(BUILD) hard

# The records are stamped with the commit that ran, so nothing may differ from it (benchmarks/run_studies).
results: benchmarks
	@benchmarks/run_studies $(BUILD) $(STUDIES)

figures:
	@benchmarks/fill_figures

FROM ?= $(patsubst %sphere,%,$(shell ls -td results/studies/*/sphere 2>/dev/null | head -1))
# The start whose PCS preview has the median distance from its final state.
SPHERE = $(FROM)sphere/runs/base/seed_1
LOCKING = configs/sphere.yaml --levels 3 --method pcs,pcs_loop,unrelaxed,cascadic --set 'methods.unrelaxed={type: pcs, relaxation: none}'
LONE_PINS = configs/pinned_square.yaml --set cloth.columns=20 --set cloth.rows=20 --method pcs,plain --set 'methods.plain={type: pcs, membranes: plain}'
SCENES = tablecloth bunny_shawl armadillo cube materials_6 pinned_square tests/cusick
draw = $(BUILD)/bin/drape run $(1) -o results/pictures/$(2) --overwrite --no-report
pictures: benchmarks data
	@[ -e $(SPHERE)/results.json ] || { echo "pictures: no run of the study sphere; make results STUDIES=sphere" >&2; exit 1; }
	$(BUILD)/bin/drape report $(SPHERE)
	rm -rf results/pictures && mkdir -p results/pictures
	set -e; $(foreach s,$(SCENES),$(call draw,configs/$(s).yaml --levels 3 --method pcs,$(notdir $(s)));)
	$(BUILD)/bin/drape report results/pictures/tablecloth
	set -e; $(foreach s,ribbon handkerchief,$(call draw,configs/$(s).yaml --method pcs,$(s));)
	sed -n '/^```yaml my_curtain/,/^```$$/{/^```/!p}' README.md >results/my_curtain.yaml
	$(call draw,results/my_curtain.yaml,curtain)
	$(call draw,configs/hard/folded.yaml --method newton,folded)
	$(call draw,$(LOCKING),locking)
	$(call draw,$(LONE_PINS),lone_pins)
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
