// Functions that the formulas in this folder call. They are right to some 10⁻⁷ however a compiler
// orders sums and products: nothing here lives on how a sum is rounded. WGSL promises 2⁻¹¹ for its own
// sine, 2⁻²¹ for its logarithm and (3 + 2|x|)·2⁻²³ of the value for its exponential, which is not enough
// where edges of a triangle cancel.

// e^(−x), x ≥ −87: a power of 2, by its bits, times a polynomial of the rest.
fn decay(x: f32) -> f32 {
    let y = min(x, 87.0);
    let n = floor(0.5 - y * 1.442695);
    let r = (n * -0.693359375 - y) + n * 0.00021219444;
    let q = r * r;
    let tail = 0.041668396 + r * (0.008368797 + r * 0.0013814433);
    let power = 1.0 + r + q * (0.49999993 + r * 0.1666652 + q * tail);
    return select(power * bitcast<f32>((i32(n) + 127) << 23u), 0.0, x > 87.0);
}

// ln((1+s)/(1−s)) for |s| ≤ 0.2: its series leaves 2·10⁻⁹.
fn logarithm_of_quotient(s: f32) -> f32 {
    let q = s * s;
    let rest = 0.33333334 + q * (0.2 + q * (0.14285715 + q * (0.11111111 + q * 0.09090909)));
    return 2.0 * (s + s * q * rest);
}

// The natural logarithm of a positive, normal number: m·2ⁿ with m from √½ to √2, by its bits.
fn logarithm(x: f32) -> f32 {
    let bits = bitcast<i32>(x);
    let n = (bits - 0x3f3504f3) >> 23u;
    let m = bitcast<f32>(bits - n * 8388608);
    return f32(n) * 0.6931472 + logarithm_of_quotient((m - 1.0) / (m + 1.0));
}

// ln(1+x), x > −1, to the last digits also where x is small.
fn logarithm_of_1_plus(x: f32) -> f32 {
    let near = clamp(x, -0.33, 0.5);
    return select(logarithm(1.0 + x), logarithm_of_quotient(near / (2.0 + near)), near == x);
}

// The inverse of the hyperbolic sine.
fn inverse_hyperbolic_sine(x: f32) -> f32 {
    let a = abs(x);
    let q = a * a;
    let y = logarithm_of_1_plus(a + q / (1.0 + sqrt(1.0 + q)));
    return select(y, -y, x < 0.0);
}

// Sine and cosine; errors grow with |x| as x's own last digit does.
fn sine_cosine(x: f32) -> vec2<f32> {
    let turns = x * 0.63661975;
    let whole = floor(turns + 0.5);
    // Of quarter turns, from −½ to ½.
    let r = (turns - whole) * 1.5707964;
    let q = r * r;
    let s = r + r * q * (-0.16666655 + q * (0.008332747 + q * -0.00019587639));
    let c = 1.0 - 0.5 * q + q * q * (0.041666664 + q * (-0.0013888302 + q * 0.00002454769));
    let quarter = whole - 4.0 * floor(whole * 0.25);
    let odd = quarter == 1.0 || quarter == 3.0;
    let swapped = select(vec2<f32>(s, c), vec2<f32>(c, s), odd);
    let signs = vec2<f32>(
        select(1.0, -1.0, quarter >= 2.0),
        select(1.0, -1.0, quarter == 1.0 || quarter == 2.0),
    );
    return swapped * signs;
}
