#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

/// One function for each reader of ours, fed with any bytes: by libFuzzer (driver.cpp), and with the corpus
/// in every `make test`. A reader takes the bytes or refuses them by UsageError or IoError; whatever else
/// comes of it, and any std::logic_error raised here, is a defect.
namespace softgrain::fuzz {

/// The bytes are a case file. What is accepted reads back from its resolved text as the same case.
void read_case_file(std::string_view bytes);

/// The bytes are the arguments of --set, a line each, on top of the first template.
void read_settings(std::string_view bytes);

/// The first byte picks a dimension, the others are a quantity: "0.2 m/s".
void read_quantity(std::string_view bytes);

/// The bytes are a snapshot file; and then, changes to the state of a small run, written and hashed as if
/// they were true, and restored.
void read_snapshot_file(std::string_view bytes);

/// The bytes are changes to the datasets of a small problem in FCLIB's format, which is read and solved. They
/// are no HDF5 file by themselves: HDF5 1.10.8 has known defects.
void read_contact_problem(std::string_view bytes);

/// The bytes are a series.csv, to be rewound and gone on with.
void read_series(std::string_view bytes);

/// The bytes are a run.json.
void read_record(std::string_view bytes);

}  // namespace softgrain::fuzz
