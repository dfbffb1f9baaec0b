#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "softgrain/io/case/case_draft.hpp"
#include "softgrain/io/case/case_forms.hpp"
#include "softgrain/io/case/case_stages.hpp"

namespace softgrain {

/// Reads the keys of forms into a draft: tables that stand several times, other spellings, and what is not
/// there yet.
class FormReader {
 public:
  explicit FormReader(CaseDraft& draft) : draft_(draft) {}

  /// All [[table]] of a name. `at`: where the name stands.
  void read_tables(const std::string& table, const TomlValue& tables, Origin at);

  /// A key of a form in an ordinary table or a --set; false if there is none of this name.
  bool read_key(const std::string& name, const TomlValue& value, Origin origin);

  /// What needs the whole file: pairs, and stages.
  void finish_file();

  const std::string& sample_file() const { return sample_file_; }
  Origin sample_file_origin() const { return sample_file_origin_; }
  const std::string& kind_name() const { return kind_name_; }

 private:
  using Visit = std::function<void(const FormKey&, const TomlValue&, Origin)>;

  void for_each_entry(const std::string& prefix, const TomlValue::Table& table, int set, const Visit& visit);
  void read_kind(const TomlValue::Table& table);
  void read_pair(const TomlValue::Table& table, Origin at);
  StageText read_stage(const TomlValue::Table& table, Origin at);
  void give(const FormKey& form, const TomlValue& value, Origin origin);
  void imply_law_of_sizes();
  bool check_word(const FormKey& form, const TomlValue& value, Origin origin);
  std::optional<double> number(const FormKey& form, const TomlValue& value, Origin origin);

  CaseDraft& draft_;
  std::string kind_name_;  // "" where no kind has a name
  std::string sample_file_;
  Origin sample_file_origin_;
  std::vector<std::pair<TomlValue::Table, Origin>> pairs_;
  std::vector<StageText> stages_;
};

/// "not yet: ..." for the name of a key that comes with a later version, else "".
std::string not_yet(const std::string& name);

}  // namespace softgrain
