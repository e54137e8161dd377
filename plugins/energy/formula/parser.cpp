#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/kernel/files/message_text.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// One token; `text` is empty at the end.
struct Token {
  enum class Kind { end, number, name, symbol };
  Kind kind = Kind::end;
  std::size_t at = 0;
  std::string text;
  double number = 0;
};

/// Cuts a formula into tokens, one at a time.
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  Token next() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    if (at_ == text_.size()) return {Token::Kind::end, at_, "", 0};
    const char c = text_[at_];
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
    if (is_letter(c)) return name();
    for (const char* two : {"**", "<=", ">=", "==", "!=", "&&", "||"})
      if (text_.substr(at_, 2) == two) return symbol(2);
    if (std::string_view("+-*/^(),<>!").find(c) != std::string_view::npos) return symbol(1);
    std::size_t length = 1;
    while (at_ + length < text_.size() && (static_cast<unsigned char>(text_[at_ + length]) & 0xc0) == 0x80)
      ++length;
    const std::string shown(text_.substr(at_, length));
    throw Fault(at_, c == '=' ? "\"=\" assigns nothing here; compare with \"==\""
                              : "\"" + excerpt(shown) + "\" has no meaning in a formula" + remedy(shown));
  }

 private:
  static std::string remedy(const std::string& shown) {
    if (shown == "·" || shown == "×") return "; multiply with \"*\"";
    if (shown == "−" || shown == "–") return "; subtract with \"-\"";
    if (shown == "²" || shown == "³") return "; write a power as x^2";
    if (shown == "[" || shown == "{") return "; group with parentheses";
    return "";
  }

  Token number() {
    Token token{Token::Kind::number, at_, "", 0};
    const auto [rest, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), token.number);
    const auto length = static_cast<std::size_t>(rest - (text_.data() + at_));
    token.text = text_.substr(at_, length);
    if (error != std::errc() || !std::isfinite(token.number))
      throw Fault(at_, "the number is too large or too small to be computed with");
    at_ += length;
    if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '.'))
      throw Fault(at_, is_letter(text_[at_])
                           ? "an operator is missing behind " + token.text + "; multiply with \"*\""
                           : "a second decimal point");
    return token;
  }

  Token name() {
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    Token token{Token::Kind::name, at_, std::string(text_.substr(at_, end - at_)), 0};
    at_ = end;
    return token;
  }

  Token symbol(std::size_t length) {
    Token token{Token::Kind::symbol, at_, std::string(text_.substr(at_, length)), 0};
    at_ += length;
    if (token.text == "**") token.text = "^";
    if (token.text == "&&") token = {Token::Kind::name, token.at, "and", 0};
    if (token.text == "||") token = {Token::Kind::name, token.at, "or", 0};
    if (token.text == "!") token = {Token::Kind::name, token.at, "not", 0};
    return token;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

class Parser {
 public:
  explicit Parser(std::string_view text) : lexer_(text) { advance(); }

  Tree parse() {
    if (token_.kind == Token::Kind::end) throw Fault(0, "the formula is empty");
    any_of();
    if (is(")")) throw Fault(token_.at, "\")\" closes nothing");
    if (token_.kind != Token::Kind::end)
      throw Fault(token_.at, "an operator is missing before " + shown(token_));
    return std::move(tree_);
  }

 private:
  /// The node that `parse` makes from behind the current token, one level deeper; `at` is the place of what
  /// goes deeper.
  template <class Parse>
  int nested(std::size_t at, const Parse& parse) {
    if (++depth_ > deepest_formula)
      throw Fault(at, "the formula is nested more than " + std::to_string(deepest_formula) +
                          " deep; name its parts in \"where\"");
    advance();
    const int node = parse();
    --depth_;
    return node;
  }

  static std::string shown(const Token& token) {
    return token.kind == Token::Kind::end ? "the end" : "\"" + excerpt(token.text) + "\"";
  }
  void advance() { token_ = lexer_.next(); }
  bool is(const char* text) const {
    return token_.kind != Token::Kind::number && token_.kind != Token::Kind::end && token_.text == text;
  }

  int add(Node node) {
    tree_.push_back(std::move(node));
    return static_cast<int>(tree_.size()) - 1;
  }
  int call(const Token& word, std::vector<int> arguments) {
    return add({Node::Kind::call, word.at, 0, word.text, std::move(arguments)});
  }

  int any_of() {
    return from_left({"or"}, [this] { return all_of(); });
  }
  int all_of() {
    return from_left({"and"}, [this] { return negated(); });
  }
  int negated() {
    if (!is("not")) return compared();
    const Token word = token_;
    return call(word, {nested(word.at, [this] { return negated(); })});
  }
  int compared() {
    const int left = sum();
    if (!is_comparison()) return left;
    const Token word = token_;
    advance();
    const int right = sum();
    if (is_comparison()) throw Fault(token_.at, "comparisons in a row; join two by \"and\"");
    return call(word, {left, right});
  }
  bool is_comparison() const { return is("<") || is("<=") || is(">") || is(">=") || is("==") || is("!="); }
  int sum() {
    return from_left({"+", "-"}, [this] { return product(); });
  }
  int product() {
    return from_left({"*", "/"}, [this] { return sign(); });
  }

  template <class Operand>
  int from_left(std::initializer_list<const char*> words, const Operand& operand) {
    int left = operand();
    while (std::ranges::any_of(words, [this](const char* word) { return is(word); })) {
      const Token word = token_;
      advance();
      const int right = operand();
      left = call(word, {left, right});
    }
    return left;
  }

  int sign() {
    if (!is("-") && !is("+")) return power();
    const Token word = token_;
    const int argument = nested(word.at, [this] { return sign(); });
    return word.text == "-" ? call(word, {argument}) : argument;
  }
  int power() {
    const int base = primary();
    if (!is("^")) return base;
    const Token word = token_;
    const int exponent = nested(word.at, [this] { return sign(); });
    return call(word, {base, exponent});
  }

  int primary() {
    const Token token = token_;
    if (token.kind == Token::Kind::number) {
      advance();
      return add({Node::Kind::number, token.at, token.number, "", {}});
    }
    if (is("(")) {
      const int inner = nested(token.at, [this] { return any_of(); });
      close(token);
      return inner;
    }
    if (token.kind != Token::Kind::name || is("and") || is("or") || is("not"))
      throw Fault(token.at, "expected a number, a name or \"(\", not " + shown(token));
    advance();
    if (!is("(")) return add({Node::Kind::name, token.at, 0, token.text, {}});
    const Token open = token_;
    return nested(token.at, [&] {
      std::vector<int> arguments;
      for (bool more = !is(")"); more; more = is(",")) {
        if (!arguments.empty()) advance();
        arguments.push_back(any_of());
      }
      close(open);
      return call(token, std::move(arguments));
    });
  }

  void close(const Token& open) {
    if (token_.kind == Token::Kind::end) throw Fault(open.at, "\"(\" is not closed");
    if (!is(")")) throw Fault(token_.at, "an operator or \")\" is missing before " + shown(token_));
    advance();
  }

  Lexer lexer_;
  Token token_;
  Tree tree_;
  int depth_ = 0;
};

}  // namespace

Tree parse(std::string_view text) {
  if (text.size() > longest_formula)
    throw Fault(longest_formula, "the formula is longer than " + std::to_string(longest_formula) +
                                     " characters; name its parts in \"where\"");
  return Parser(text).parse();
}

}  // namespace drape::formula
