# Short names for the commands of everyday work; each recipe also works typed by hand.
.DEFAULT_GOAL := help
.PHONY: help demo test check docs live torture gallery bench clean

help: ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "make %-7s %s\n", $$1, $$2}' Makefile

demo: ## one soft grain between two walls: builds, simulates, draws (out/demo/figures)
	@tools/install_dependencies.sh
	cmake --preset release
	cmake --build --preset release
	build/release/softgrain run experiments/diametral_bpm/case.toml -o out/demo --force
	build/release/softgrain plot out/demo
	@echo "The pictures lie in out/demo/figures, the numbers in out/demo/series.csv; open out/demo/report.html in a browser"

test: ## builds with warnings as errors and runs all tests
	@tools/install_dependencies.sh
	cmake --preset dev
	cmake --build --preset dev
	ctest --preset dev

check: ## format, layers, self-contained headers, the library for the browser, links of the documentation, clang-tidy
	@tools/install_dependencies.sh --with checks --with docs
	cmake --preset dev
	tools/check_format
	tools/check_layers --self-test
	tools/check_layers
	tools/check_headers
	tools/check_viewer
	tools/check_wasm
	tools/check_docs
	tools/build_site
	tools/check_tidy

docs: ## the documentation as a site, build/site/index.html, with every link checked
	@tools/install_dependencies.sh --with docs
	tools/check_docs
	tools/build_site

live: ## the live page, build/live/index.html: the solver in a browser, by Emscripten (minutes); make docs takes it in
	@tools/install_dependencies.sh --with wasm --with viewer
	tools/build_live

torture: ## long forms of the reliability tests, fuzzers, sanitizers, builds compared, a wheel, 64-bit ARM (hours)
	@tools/install_dependencies.sh --with torture --with wheel
	/usr/bin/python3 -m build --wheel --no-isolation --outdir build/wheel
	tools/check_wheel build/wheel/softgrain-*.whl
	cmake --preset dev
	cmake --build --preset dev
	SOFTGRAIN_TORTURE=1 ctest --preset dev -L reliability --timeout 7200
	cmake --preset fuzz
	cmake --build --preset fuzz
	tests/fuzz/run
	tools/compare_builds
	cmake --preset aarch64
	cmake --build --preset aarch64
	ctest --preset aarch64 -L portable
	cmake --preset asan
	cmake --build --preset asan
	ctest --preset asan -L "unit|verification" --timeout 7200
	cmake --preset tsan
	cmake --build --preset tsan
	ctest --preset tsan -L unit --timeout 7200

gallery: ## makes the pictures of docs/gallery anew, each by the command that stands beside it (minutes)
	cmake --preset release
	cmake --build --preset release
	tools/gallery build/release/softgrain

bench: ## measures the speed, ours and the peers'
	@tools/install_dependencies.sh --with bench
	cmake --preset bench
	cmake --build --preset bench
	cmake --build --preset bench --target run_benchmarks

clean: ## removes build/ and out/
	rm -rf build out
