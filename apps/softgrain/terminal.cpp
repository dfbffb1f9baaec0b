#include "terminal.hpp"

#include <unistd.h>

#include <cstdlib>

#include "softgrain/core/error.hpp"

namespace softgrain {

bool wants_colour(std::FILE* stream) {
  const char* no_colour = std::getenv("NO_COLOR");
  if (no_colour != nullptr && *no_colour != '\0') return false;
  const char* terminal = std::getenv("TERM");
  if (terminal == nullptr || std::string_view(terminal) == "dumb") return false;
  return isatty(fileno(stream)) == 1;
}

void print_error(std::string_view message) {
  std::string text(message);
  if (wants_colour(stderr)) {
    constexpr std::string_view word = "error:";
    constexpr std::string_view red_word = "\033[1;31merror:\033[0m";
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + red_word.size()))
      text.replace(at, word.size(), red_word);
  }
  if (text.empty() || text.back() != '\n') text += '\n';
  std::fflush(stdout);
  std::fputs(text.c_str(),
             stderr);  // fmt::print would raise when stderr is full, and nobody is left to catch
}

void print_result(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  check_stdout();
}

void check_stdout() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw IoError("cannot write to stdout");
}

}  // namespace softgrain
