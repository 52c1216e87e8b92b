# What is given away: `make release` builds all of it into target/packages, with checksums.
# Needs cargo-deb (`cargo install cargo-deb`), Python 3.9 or newer, and for the static program the Rust target TARGET
# (`rustup target add x86_64-unknown-linux-musl`); `make static TARGET=x86_64-unknown-linux-gnu` links glibc into it.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.ONESHELL:
TARGET ?= x86_64-unknown-linux-musl
export CARGO_TARGET_DIR ?= $(CURDIR)/target

version := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
built := $(CARGO_TARGET_DIR)
packages := $(built)/packages
share := $(CURDIR)/target/share
name := stickslip-$(version)-$(TARGET)

.PHONY: release crate static deb wheel share checksums
release: crate static deb wheel checksums

# The crates as `cargo publish` would send them, compiled from what is in them.
crate:
	cargo package --locked -p stickslip-numerics -p stickslip
	install -D -m 644 $(built)/package/stickslip-$(version).crate $(built)/package/stickslip-numerics-$(version).crate -t $(packages)

# One file that runs on any Linux of this processor, with manual, completions and examples beside it.
static:
	RUSTFLAGS="-C target-feature=+crt-static" cargo build --locked --profile dist --target $(TARGET)
	program=$(built)/$(TARGET)/dist/stickslip
	if readelf -d $$program | grep -q NEEDED; then echo "$$program is not static" >&2; exit 1; fi
	folder=$(built)/$(name)
	rm -rf $$folder
	install -D -m 755 $$program $$folder/stickslip
	bash .ci/share $$program $$folder
	cp -r README.md CHANGELOG.md LICENSE-APACHE LICENSE-MIT scenarios $$folder
	mkdir -p $(packages)
	tar -C $(built) --owner=0 --group=0 --sort=name -czf $(packages)/$(name).tar.gz $(name)

# Manual and completions, as the program writes them; `cargo deb` takes them from there.
share:
	cargo build --locked --profile dist
	bash .ci/share $(built)/dist/stickslip $(share)

deb: share
	cargo deb --locked --no-build --profile dist --output $(packages)/

wheel:
	[ -x $(built)/packaging/bin/python ] || python3 -m venv $(built)/packaging
	$(built)/packaging/bin/python -m pip install -q 'maturin>=1.9,<2'
	$(built)/packaging/bin/maturin build --locked --profile dist -o $(packages)

checksums:
	cd $(packages)
	sha256sum -- *.crate *.tar.gz *.deb *.whl > SHA256SUMS
	cat SHA256SUMS
