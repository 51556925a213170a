// SHA-256 through OpenSSL's libcrypto.
#include "host/app/checksum.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "sim/error.hpp"

namespace understory {
namespace {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    check(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
  }
  void add(const void* data, std::size_t bytes) { check(EVP_DigestUpdate(context_.get(), data, bytes)); }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    check(EVP_DigestFinal_ex(context_.get(), digest.data(), &length));
    std::string text;
    for (unsigned i = 0; i < length; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
  }

 private:
  static void check(int succeeded) {
    if (succeeded != 1) throw Error(ErrorKind::unexpected, "libcrypto cannot compute SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256_of_text(std::string_view text) {
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.hexadecimal();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw Error(ErrorKind::input_output, fmt::format("{}: cannot be opened for reading", path.string()));
  Sha256 hash;
  std::vector<unsigned char> block(1 << 20);
  while (const std::size_t bytes = std::fread(block.data(), 1, block.size(), file.get())) hash.add(block.data(), bytes);
  if (std::ferror(file.get())) throw Error(ErrorKind::input_output, fmt::format("{}: cannot be read", path.string()));
  return hash.hexadecimal();
}

}  // namespace understory
