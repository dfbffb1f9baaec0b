#pragma once
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "softgrain/math/vec.hpp"
#include "softgrain/state/array.hpp"

namespace softgrain {

/// What a row of an array belongs to. Particles of a grain and walls are bodies of the contact problem; nodes
/// and points are those of a grain's grid.
enum class Owner { run, wall, grain, body, node, point, contact };

/// Why an array is part of the state.
enum class Role {
  state,  ///< the equations of motion go on from it
  start,  ///< an iteration starts from it: without it, the next step has other bits
  list,   ///< decides when lists of neighbours are made again, and their order
  sum     ///< is added up between two rows, or over the run
};

/// One array of the state of a simulation, as the struct that owns it declares it.
struct Field {
  std::string name;       ///< of its dataset
  std::string_view unit;  ///< SI, "" for none
  Owner owner = Owner::run;
  Role role = Role::state;
  std::string_view text;  ///< one sentence for docs/format.md
};

/// Sees every array of a state once. Each struct declares its arrays in one function,
///   void visit(StateVisitor& visit) { visit({"spin", "m/s", Owner::body, Role::state, "..."}, spin); }
/// and all that goes over the state, to write, to read, to list, is a visitor.
class StateVisitor {
 public:
  virtual ~StateVisitor() = default;
  /// True if the arrays get new values.
  virtual bool reads() const = 0;

  /// One number: of a real, integer or enumerated type.
  template <class T>
  void operator()(const Field& field, T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      std::vector<double> values{value};
      reals(field, values, 1, Length::fixed);
      value = values.front();
    } else {
      std::vector<std::int64_t> values{static_cast<std::int64_t>(value)};
      integers(field, values, 1, Length::fixed);
      value = static_cast<T>(values.front());
    }
  }
  void operator()(const Field& field, std::vector<double>& values) { reals(field, values, 1, Length::fixed); }
  template <int N>
  void operator()(const Field& field, std::vector<Vec<N>>& rows) {
    vectors(field, rows, Length::fixed);
  }
  /// An array of rows of so many numbers, of any length: what is read decides it.
  template <int N>
  void list(const Field& field, std::vector<Vec<N>>& rows) {
    vectors(field, rows, Length::any);
  }
  void list(const Field& field, std::vector<std::int64_t>& values, std::size_t columns) {
    integers(field, values, columns, Length::any);
  }
  /// Rows of so many numbers that lie elsewhere in another form.
  void rows(const Field& field, std::vector<double>& values, std::size_t columns) {
    reals(field, values, columns, Length::fixed);
  }

 protected:
  friend class PartVisitor;
  enum class Length { fixed, any };
  virtual void reals(const Field& field, std::vector<double>& values, std::size_t columns, Length length) = 0;
  virtual void integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns,
                        Length length) = 0;

 private:
  template <int N>
  void vectors(const Field& field, std::vector<Vec<N>>& rows, Length length) {
    std::vector<double> values = flat_rows(rows);
    reals(field, values, N, length);
    if (!reads()) return;
    rows.resize(values.size() / N);
    for (std::size_t i = 0; i < values.size(); ++i) rows[i / N][static_cast<int>(i % N)] = values[i];
  }
};

/// Sees the arrays of a part of a state, for the visitor of the whole: "position" with the prefix "bonded_"
/// is "bonded_position" there.
class PartVisitor final : public StateVisitor {
 public:
  /// Keeps a reference.
  PartVisitor(StateVisitor& whole, std::string prefix) : whole_(whole), prefix_(std::move(prefix)) {}
  bool reads() const override { return whole_.reads(); }

 private:
  void reals(const Field& field, std::vector<double>& values, std::size_t columns, Length length) override {
    whole_.reals(named(field), values, columns, length);
  }
  void integers(const Field& field, std::vector<std::int64_t>& values, std::size_t columns,
                Length length) override {
    whole_.integers(named(field), values, columns, length);
  }
  Field named(Field field) const {
    field.name = prefix_ + field.name;
    return field;
  }

  StateVisitor& whole_;
  std::string prefix_;
};

/// A matrix, row by row.
template <int N>
void visit_matrix(StateVisitor& visit, const Field& field, Mat<N>& matrix) {
  std::vector<double> entries(matrix.c.begin(), matrix.c.end());
  visit(field, entries);
  std::copy(entries.begin(), entries.end(), matrix.c.begin());
}

}  // namespace softgrain
