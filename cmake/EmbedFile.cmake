# cmake -D INPUT=file -D OUTPUT=file.cpp -D NAME=symbol -P EmbedFile.cmake
# Turns a file into `extern const std::string_view softgrain::NAME`, so that the program needs no file beside it.
file(READ "${INPUT}" bytes HEX)
string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include <string_view>
namespace softgrain {
extern const std::string_view ${NAME};
constexpr unsigned char bytes[] = {
${bytes}};
const std::string_view ${NAME}(reinterpret_cast<const char*>(bytes), sizeof bytes);
}  // namespace softgrain
")
