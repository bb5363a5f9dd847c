// Short texts and numbers, drawn dot by dot: one quad per letter, whose vertices work out the letter and whose fragments
// ask for its dots. Letters are ASCII codes; there are digits, small letters and % + - . / :, all others are blank.

const int kLetterWidth = 6;   // dots from one letter to the next; the last column is empty
const int kLetterHeight = 8;  // the last row is for tails
const int kTextLength = 12;   // letters that a text is drawn with; more are cut off

// A text is up to twelve letters, then a number, then up to four letters; each part may be missing. Whoever draws asks for one
// letter after the other: in arrays of letters llvmpipe would take seconds to compile.
struct Number {
    bool is_negative;
    int digits;       // all of them as one whole number
    int whole;        // how many stand before the point, 1 or more
    int fraction;     // how many behind it
    int exponent;     // what follows "e"; 0: there is none
    int length;       // in letters
};

struct Text {
    uvec3 word;       // four letters each, the first in the highest byte
    int word_length;
    bool has_number;
    Number number;
    uint suffix;      // as word
    int suffix_length;
};

int whole_power_of_ten(int exponent) {
    int power = 1;
    for (int i = 0; i < exponent; ++i) power *= 10;
    return power;
}

// 10 to the power of `exponent`, from -38 to 38.
float power_of_ten(int exponent) {
    float power = 1.0;
    for (int i = 0; i < abs(exponent); ++i) power *= 10.0;
    return exponent < 0 ? 1.0 / power : power;
}

// The decimal exponent of a finite value from 1e-37 on.
int decimal_exponent(float value) {
    int exponent = clamp(int(floor(log2(value) * 0.30103)), -37, 38);
    // The logarithm may be off by one where the value is a power of ten.
    float ratio = value / power_of_ten(exponent);
    return exponent + (ratio >= 10.0 ? 1 : ratio < 1.0 ? -1 : 0);
}

// A finite number with four digits, fewer where the last ones are 0; whole numbers below a million in full; "1.2e-5" beyond
// 0.001 and a million.
Number make_number(float value) {
    float size = abs(value);
    bool is_zero = !(size >= 1e-37), is_whole = size < 1e6 && size == floor(size);
    int exponent = is_zero ? 0 : decimal_exponent(size), digits = 4;
    int number = int(floor(size / power_of_ten(exponent) * 1000.0 + 0.5));
    if (number >= 10000) {
        number = 1000;
        ++exponent;
    }
    if (is_whole || is_zero) {
        number = int(size);
        digits = exponent + 1;
    }
    bool scientific = exponent < -3 || exponent >= 6;
    int fraction = max(digits - 1 - (scientific ? 0 : exponent), 0);
    for (int i = 0; i < 8; ++i)
        if (fraction > 0 && number % 10 == 0) {
            number /= 10;
            --fraction;
        }
    // Four digits of a number above 9999 that is not whole.
    int missing = max(scientific ? 0 : exponent + 1 - digits, 0);
    number *= whole_power_of_ten(missing);
    int whole = scientific ? 1 : max(exponent + 1, 1);
    int tail = scientific ? 1 + (exponent < 0 ? 1 : 0) + (abs(exponent) > 9 ? 2 : 1) : 0;
    int length_ = (value < 0.0 ? 1 : 0) + whole + (fraction > 0 ? fraction + 1 : 0) + tail;
    return Number(value < 0.0 && !is_zero, number, whole, fraction, scientific ? exponent : 0, length_);
}

uint number_letter(Number number, int at) {
    if (number.is_negative && at-- == 0) return 45u;  // -
    int tail = at - number.whole - (number.fraction > 0 ? number.fraction + 1 : 0);
    if (tail >= 0) {
        if (tail-- == 0) return 101u;  // e
        if (number.exponent < 0 && tail-- == 0) return 45u;
        int size = abs(number.exponent);
        return 48u + uint(size > 9 && tail == 0 ? size / 10 : size % 10);
    }
    if (at == number.whole) return 46u;  // .
    int digit = at < number.whole ? at : at - 1;
    return 48u + uint(number.digits / whole_power_of_ten(number.whole + number.fraction - 1 - digit) % 10);
}

Text text_of(uvec3 word, int word_length) {
    return Text(word, word_length, false, Number(false, 0, 1, 0, 0, 1), 0u, 0);
}

int text_length(Text text) {
    int length_ = text.word_length + (text.has_number ? text.number.length : 0) + text.suffix_length;
    return min(length_, kTextLength);
}

uint letter_of(Text text, int at) {
    if (at < text.word_length) return (text.word[at / 4] >> (24 - 8 * (at % 4))) & 255u;
    at -= text.word_length;
    int number_length = text.has_number ? text.number.length : 0;
    if (at < number_length) return number_letter(text.number, at);
    return (text.suffix >> (24 - 8 * (at - number_length))) & 255u;
}

// The dots of a letter: four rows of five in each number, the top left one in the highest of 20 bits.
uvec2 letter_dots(uint letter) {
    const uint kFirst = 37u;
    const uvec2 dots[] = uvec2[](
        uvec2(0xc6444u, 0x44c60u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x0109fu, 0x21000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x0001fu, 0x00000u), uvec2(0x00000u, 0x03180u), uvec2(0x00444u, 0x44000u), uvec2(0x74675u, 0xcc5c0u),
        uvec2(0x23084u, 0x211c0u), uvec2(0x74422u, 0x223e0u), uvec2(0xf8882u, 0x0c5c0u), uvec2(0x11952u, 0xf8840u),
        uvec2(0xfc3c1u, 0x0c5c0u), uvec2(0x3221eu, 0x8c5c0u), uvec2(0xf8444u, 0x42100u), uvec2(0x7462eu, 0x8c5c0u),
        uvec2(0x7462fu, 0x08980u), uvec2(0x03180u, 0x63000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u), uvec2(0x00000u, 0x00000u),
        uvec2(0x001c1u, 0x7c5e0u), uvec2(0x842d9u, 0x8c7c0u), uvec2(0x001d0u, 0x845c0u), uvec2(0x085b3u, 0x8c5e0u),
        uvec2(0x001d1u, 0xfc1c0u), uvec2(0x3251cu, 0x42100u), uvec2(0x001f1u, 0x8bc2eu), uvec2(0x842d9u, 0x8c620u),
        uvec2(0x20184u, 0x211c0u), uvec2(0x100c2u, 0x10a4cu), uvec2(0x84254u, 0xc5240u), uvec2(0x61084u, 0x211c0u),
        uvec2(0x00355u, 0xac620u), uvec2(0x002d9u, 0x8c620u), uvec2(0x001d1u, 0x8c5c0u), uvec2(0x003d1u, 0x8fa10u),
        uvec2(0x001b3u, 0x8bc21u), uvec2(0x002d9u, 0x84200u), uvec2(0x001f0u, 0x707c0u), uvec2(0x42388u, 0x424c0u),
        uvec2(0x00231u, 0x8cda0u), uvec2(0x00231u, 0x8a880u), uvec2(0x00231u, 0xad540u), uvec2(0x0022au, 0x22a20u),
        uvec2(0x00231u, 0x8bc2eu), uvec2(0x003e2u, 0x223e0u));
    return letter < kFirst || letter >= kFirst + uint(dots.length()) ? uvec2(0u) : dots[letter - kFirst];
}

// Whether a letter has the dot in column 0..4 and row 0..7.
bool has_dot(uvec2 dots, ivec2 at) {
    if (any(lessThan(at, ivec2(0))) || at.x > 4 || at.y > 7) return false;
    uint rows = at.y < 4 ? dots.x : dots.y;
    return ((rows >> (19 - 5 * (at.y & 3) - at.x)) & 1u) != 0u;
}
