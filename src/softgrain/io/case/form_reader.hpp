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

  /// What needs the whole file: pairs.
  void finish_file();
  /// What the tables [[stage]] say, when all else of the case is known.
  void finish_stages();

  const std::string& sample_file() const { return sample_file_; }
  Origin sample_file_origin() const { return sample_file_origin_; }
  /// Of all kinds, in their order; "" where the only one has none.
  std::vector<std::string> kind_names() const;

  /// Several kinds, once all keys and overrides and the places of the grains are known.
  void finish_kinds();

 private:
  using Visit = std::function<void(const FormKey&, const TomlValue&, Origin)>;

  void for_each_entry(const std::string& prefix, const TomlValue::Table& table, int set, const Visit& visit);
  /// What one of several kinds says.
  struct KindText {
    struct Entry {
      const FormKey* form;
      TomlValue value;
      Origin origin;
    };
    std::string name;
    Origin at;
    double share = 0;  // 0: none is given
    bool has_number = false;
    std::vector<Entry> entries;
  };
  void read_kind(const TomlValue::Table& table);
  void keep_kind(const TomlValue::Table& table, Origin at);
  bool keep_key_of_kind(const std::string& name, const TomlValue& value, Origin origin);
  void finish_kind(KindText& text);
  GrainModel model_of_silent_kinds() const;
  void settle_models();
  void count_grains();
  void count_placed();
  /// What a table [[pair]] says but of its sides.
  struct PairNumber {
    const FormKey* form;
    const TomlValue* value;
    Origin origin;
  };
  using PairNumbers = std::vector<PairNumber>;
  void add_pair(int walls, const std::vector<std::string>& sides, const PairNumbers& numbers);
  void read_pair(const TomlValue::Table& table, Origin at);
  StageText read_stage(const TomlValue::Table& table, Origin at);
  void give(const FormKey& form, const TomlValue& value, Origin origin);
  void imply_law_of_sizes();
  void imply_shape();
  bool check_word(const FormKey& form, const TomlValue& value, Origin origin);
  std::optional<double> number(const FormKey& form, const TomlValue& value, Origin origin);

  CaseDraft& draft_;
  std::string kind_name_;        // of the only kind, "" where it has none
  std::vector<KindText> kinds_;  // where there are several
  std::string sample_file_;
  Origin sample_file_origin_;
  std::vector<std::pair<TomlValue::Table, Origin>> pairs_;
  std::vector<StageText> stages_;
};

/// "not yet: ..." for the name of a key that comes with a later version, else "".
std::string not_yet(const std::string& name);

}  // namespace softgrain
