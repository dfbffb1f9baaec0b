#pragma once
#include <cstdio>
#include <string>
#include <string_view>

namespace softgrain {

/// Colour only where a person looks: `stream` is a terminal, NO_COLOR is unset or empty, TERM is not "dumb".
bool wants_colour(std::FILE* stream);

/// Prints an error message to stderr with one newline at its end; the word "error:" is red where colour is
/// wanted.
void print_error(std::string_view message);

/// Prints a result to stdout, at once. Raises IoError when it cannot be written.
void print_result(std::string_view text);

/// Raises IoError when something of what was printed to stdout could not be written.
void check_stdout();

}  // namespace softgrain
