#pragma once
#include <string>
#include <vector>

#include "softgrain/state/field.hpp"

namespace softgrain {

/// Copies every array of a state.
class StateWriter final : public StateVisitor {
 public:
  bool reads() const override { return false; }
  Arrays arrays;

 private:
  void reals(const Field& field, std::vector<double>& values, std::size_t columns, Length length) override;
  void integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns,
                Length length) override;
};

/// Gives every array of a state the values of a copy. Raises IoError, naming the array, where it is missing,
/// has another shape or holds what is no finite number.
class StateReader final : public StateVisitor {
 public:
  explicit StateReader(const Arrays& arrays) : arrays_(arrays) {}
  bool reads() const override { return true; }

 private:
  void reals(const Field& field, std::vector<double>& values, std::size_t columns, Length length) override;
  void integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns,
                Length length) override;
  template <class T>
  void read(const Field& field, std::vector<T>& values, std::size_t columns, Length length) const;

  const Arrays& arrays_;
};

/// What an array is, without its values.
struct FieldShape {
  Field field;
  std::size_t columns = 1;
  bool integers = false;
};

/// Lists the arrays of a state in the order of their declaration.
class StateLister final : public StateVisitor {
 public:
  bool reads() const override { return false; }
  std::vector<FieldShape> fields;

 private:
  void reals(const Field& field, std::vector<double>& values, std::size_t columns, Length length) override;
  void integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns,
                Length length) override;
};

}  // namespace softgrain
