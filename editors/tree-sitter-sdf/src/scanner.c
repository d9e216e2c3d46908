// The tokens that depend on the rest of the line, and literals that must end where they end.
//
// A newline ends an item or a `let` unless the next token continues the expression: an infix
// operator, `.`, `in`, or `;`, which ends it as well. A `(` or `[` that is first on its line never
// continues the line before. A letter behind a number or a colour belongs to it, so `3in` is one
// wrong number, not `3 in`.

#include "tree_sitter/parser.h"

enum TokenType { END_OF_LINE, CALL_OPEN, INDEX_OPEN, LAMBDA_END, NUMBER, COLOR, ERROR_SENTINEL };

void *tree_sitter_sdf_external_scanner_create(void) { return NULL; }

void tree_sitter_sdf_external_scanner_destroy(void *payload) { (void)payload; }

unsigned tree_sitter_sdf_external_scanner_serialize(void *payload, char *buffer) {
  (void)payload;
  (void)buffer;
  return 0;
}

void tree_sitter_sdf_external_scanner_deserialize(void *payload, const char *buffer, unsigned length) {
  (void)payload;
  (void)buffer;
  (void)length;
}

static bool is_space(int32_t c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f'; }

static bool is_digit(int32_t c) { return c >= '0' && c <= '9'; }

static bool is_word(int32_t c) {
  return is_digit(c) || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_hexadecimal(int32_t c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

static void advance(TSLexer *lexer) { lexer->advance(lexer, false); }

static void digits(TSLexer *lexer) {
  while (is_digit(lexer->lookahead)) advance(lexer);
}

/// Reads the word of at most 7 letters that comes next; a longer one is cut.
static void word(TSLexer *lexer, char text[8]) {
  unsigned length = 0;
  while (is_word(lexer->lookahead)) {
    if (length < 7) text[length++] = (char)lexer->lookahead;
    advance(lexer);
  }
  text[length] = 0;
}

static bool is(const char *text, const char *other) {
  while (*text && *text == *other) text++, other++;
  return *text == *other;
}

/// Digits, point, exponent, unit. The first digit comes next.
static bool scan_number(TSLexer *lexer) {
  lexer->result_symbol = NUMBER;
  digits(lexer);
  lexer->mark_end(lexer);
  if (lexer->lookahead == '.') {
    advance(lexer);
    // `0..1` is a range and `1.x` a field.
    if (!is_digit(lexer->lookahead)) return true;
    digits(lexer);
    lexer->mark_end(lexer);
  }
  if (lexer->lookahead == 'e') {
    advance(lexer);
    if (lexer->lookahead == '+' || lexer->lookahead == '-') advance(lexer);
    if (!is_digit(lexer->lookahead)) return false;
    digits(lexer);
    lexer->mark_end(lexer);
  }
  if (!is_word(lexer->lookahead)) return true;
  char unit[8];
  word(lexer, unit);
  lexer->mark_end(lexer);
  return is(unit, "deg") || is(unit, "turn") || is(unit, "rad");
}

/// 3, 4, 6 or 8 hexadecimal digits behind `#`, which comes next.
static bool scan_color(TSLexer *lexer) {
  lexer->result_symbol = COLOR;
  advance(lexer);
  unsigned length = 0;
  while (is_hexadecimal(lexer->lookahead)) {
    length++;
    advance(lexer);
  }
  lexer->mark_end(lexer);
  return !is_word(lexer->lookahead) && (length == 3 || length == 4 || length == 6 || length == 8);
}

/// What the next token does to the expression before it.
enum Next { CONTINUES, ENDS_THE_ITEM, BEGINS };

/// Looks at the token behind white space and comments.
static enum Next next_token(TSLexer *lexer) {
  switch (lexer->lookahead) {
    case '.':
      // `.5` is a wrong number that begins a line.
      advance(lexer);
      return is_digit(lexer->lookahead) ? BEGINS : CONTINUES;
    case '|':
    case '&':
    case '+':
    case '-':
    case '*':
    case '/':
    case '%':
    case '<':
    case '>':
      return CONTINUES;
    case ';':
      return ENDS_THE_ITEM;
    case '=':
    case '!':
      advance(lexer);
      return lexer->lookahead == '=' ? CONTINUES : BEGINS;
    case 'i': {
      char text[8];
      word(lexer, text);
      return is(text, "in") ? ENDS_THE_ITEM : BEGINS;
    }
    default:
      return BEGINS;
  }
}

/// A zero-width token: the end of a lambda if no operator follows, otherwise the end of the line if
/// the next one does not continue it.
static bool scan_end(TSLexer *lexer, bool ends_lambda) {
  lexer->mark_end(lexer);
  lexer->result_symbol = ends_lambda ? LAMBDA_END : END_OF_LINE;
  bool is_first = false;
  for (;;) {
    while (is_space(lexer->lookahead)) {
      is_first |= lexer->lookahead == '\n';
      advance(lexer);
    }
    if (lexer->eof(lexer)) return true;
    if (lexer->lookahead != '/') break;
    advance(lexer);
    if (lexer->lookahead != '/') return false;
    while (lexer->lookahead != '\n' && !lexer->eof(lexer)) advance(lexer);
  }
  enum Next next = next_token(lexer);
  return ends_lambda ? next != CONTINUES : is_first && next == BEGINS;
}

bool tree_sitter_sdf_external_scanner_scan(void *payload, TSLexer *lexer, const bool *valid_symbols) {
  (void)payload;
  bool recovers = valid_symbols[ERROR_SENTINEL];
  // Spaces are skipped, so that a token behind them begins where it is written.
  while (is_space(lexer->lookahead) && lexer->lookahead != '\n') lexer->advance(lexer, true);
  if (!recovers) {
    bool at_end = lexer->lookahead == '\n' || lexer->lookahead == '/' || lexer->eof(lexer);
    bool at_bracket = lexer->lookahead == '(' || lexer->lookahead == '[';
    if (valid_symbols[LAMBDA_END] && !at_bracket) return scan_end(lexer, true);
    if (valid_symbols[END_OF_LINE] && at_end) return scan_end(lexer, false);
  }
  bool is_first = false;
  while (is_space(lexer->lookahead)) {
    is_first |= lexer->lookahead == '\n';
    lexer->advance(lexer, true);
  }
  if (is_digit(lexer->lookahead)) return valid_symbols[NUMBER] && scan_number(lexer);
  if (lexer->lookahead == '#') return valid_symbols[COLOR] && scan_color(lexer);
  if (is_first || recovers) return false;
  if (lexer->lookahead == '(' && valid_symbols[CALL_OPEN]) {
    lexer->result_symbol = CALL_OPEN;
  } else if (lexer->lookahead == '[' && valid_symbols[INDEX_OPEN]) {
    lexer->result_symbol = INDEX_OPEN;
  } else {
    return false;
  }
  advance(lexer);
  lexer->mark_end(lexer);
  return true;
}
