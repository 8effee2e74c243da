// Numbers to a file, as they lie in memory: what this processor answers, for web/test to hold the package to.
#pragma once

#include <cstdio>
#include <span>
#include <vector>

namespace sightline::web {

class Writer {
public:
  explicit Writer(std::FILE* file) : file_(file) {}
  template <class T>
  void all(std::span<const T> values) {
    good_ = std::fwrite(values.data(), sizeof(T), values.size(), file_) == values.size() && good_;
  }
  template <class T>
  void all(const std::vector<T>& values) {
    all(std::span(values));
  }
  template <class T>
  void one(const T& value) {
    all(std::span(&value, 1));
  }
  [[nodiscard]] bool good() const { return good_; }

private:
  std::FILE* file_;
  bool good_ = true;
};

}  // namespace sightline::web
